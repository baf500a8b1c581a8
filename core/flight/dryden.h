// Dryden turbulence, translational and rotational (T A.4; MIL-HDBK-1797, above 2000 ft), exact at the ticks.
//
// Power spectral densities are one-sided in w = 2 pi f (rad/s), so that the variance is their integral over w
// from 0 to infinity; V airspeed of the filters, b span, one length L and one sigma for all axes (isotropic):
//   Phi_u = sigma^2 (2L/(pi V)) / (1 + (L w/V)^2)
//   Phi_v = Phi_w = sigma^2 (L/(pi V)) (1 + 3 (L w/V)^2) / (1 + (L w/V)^2)^2
//   Phi_p = (sigma^2/(V L)) 0.8 (pi L/(4b))^(1/3) / (1 + (4 b w/(pi V))^2)
//   Phi_q = (w/V)^2 / (1 + (4 b w/(pi V))^2) Phi_w
//   Phi_r = (w/V)^2 / (1 + (3 b w/(pi V))^2) Phi_v
// The handbook writes L_u = 2 L_v = 2 L_w = 1750 ft, which are the same spectra. Two-sided in f (Hz), as a
// DFT shows them: S(f) = pi Phi(2 pi |f|).
//
// The air's rotation follows from its velocity along the flight path x (frozen field, d/dx = (1/V) d/dt): a
// body turning with q moves its points by -q x in z and one turning with r by r x in y, so that q_g =
// -dw_g/dx and r_g = dv_g/dx, each behind its lag. p_g is independent of the others.
#pragma once

#include <Eigen/Dense>
#include <array>

#include "core/random/random_stream.h"

namespace fatmc {

inline constexpr double kDrydenLength = 533.4;  ///< m, 1750 ft

/// One-sided PSD at angular frequency w (rad/s) of channel 0..5 = u, v, w (m^2/s^2 per rad/s), p, q, r
/// (rad^2/s^2 per rad/s), for the conventions above.
double dryden_psd(int channel, double omega_rad_s, double sigma_m_s, double airspeed_m_s, double span_m);

/// White-noise filters with the PSDs above, discretised exactly (Van Loan): at the ticks the gusts have the
/// very covariance and autocovariance of the continuous process. Between ticks they are held.
class Dryden {
 public:
  static constexpr int kStates = 8;  ///< u | v (2), r | w (2), q | p

  /// airspeed > 0, tick > 0, span > 0, sigma >= 0.
  Dryden(double sigma_m_s, double airspeed_m_s, double span_m, double tick_s);

  using Gusts = std::array<double, 6>;  ///< u, v, w, p, q, r
  using StateVector = std::array<double, kStates>;

  /// A draw from the stationary distribution.
  [[nodiscard]] StateVector start(RandomStream& random) const;
  [[nodiscard]] Gusts gusts(const StateVector& x) const;
  void advance(StateVector& x, RandomStream& random) const;

  /// Covariance of the stationary state, for tests: P = A P A' + Q.
  [[nodiscard]] Eigen::Matrix<double, 6, 6> covariance() const;
  /// One-sided PSD in w of the sequence at the ticks, 0 < w < pi/tick: the continuous PSD with all its
  /// aliases.
  [[nodiscard]] double sampled_psd(int channel, double omega_rad_s) const;

 private:
  /// A chain driven by one white noise: one state (u, p) or three (v with r, w with q).
  template <int N>
  struct Chain {
    Eigen::Matrix<double, N, N> transition, noise_factor, start_factor, covariance;
  };
  template <int N>
  static Chain<N> discretise(const Eigen::Matrix<double, N, N>& a, const Eigen::Matrix<double, N, 1>& b,
                             double tick_s);

  double tick_s_;
  Chain<1> forward_, rolling_;
  Chain<3> side_, vertical_;
  Eigen::Matrix<double, 2, 3> side_output_, vertical_output_;
};

}  // namespace fatmc
