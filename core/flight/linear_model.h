// The aircraft linearised about trim: continuous, and as the step map that is actually flown.
#pragma once

#include <Eigen/Dense>
#include <complex>
#include <string_view>
#include <vector>

#include "core/flight/trim.h"

namespace fatmc {

/// States of the linear model: deviations from trim. Heading, position and height are left out, since nothing
/// depends on them.
inline constexpr int kLinearStates = 16;
inline constexpr std::array<std::string_view, kLinearStates> kLinearStateNames = {"u",
                                                                                  "v",
                                                                                  "w",
                                                                                  "p",
                                                                                  "q",
                                                                                  "r",
                                                                                  "phi",
                                                                                  "theta",
                                                                                  "propeller",
                                                                                  "throttle",
                                                                                  "aileron",
                                                                                  "left_ruddervator",
                                                                                  "right_ruddervator",
                                                                                  "aileron_rate",
                                                                                  "left_ruddervator_rate",
                                                                                  "right_ruddervator_rate"};
inline constexpr std::array<std::string_view, 3> kInputNames = {"xi_c", "eta_c", "zeta_c"};
inline constexpr std::array<std::string_view, 3> kOutputNames = {"p", "q", "r"};

using LinearStateMatrix = Eigen::Matrix<double, kLinearStates, kLinearStates>;
using LinearInputMatrix = Eigen::Matrix<double, kLinearStates, 3>;
using LinearGustMatrix = Eigen::Matrix<double, kLinearStates, 6>;
using LinearOutputMatrix = Eigen::Matrix<double, 3, kLinearStates>;

/// Continuous: dx/dt = A x + B u + E g.   Sampled: x[k+1] = A x[k] + B u[k] + E g[k].   y = C x + D u, D = 0.
/// u: normalised commands (xi_c, eta_c, zeta_c); g: gusts (u, v, w in m/s, p, q, r in rad/s) in body axes.
struct LinearModel {
  double sample_time_s = 0.0;  ///< 0: continuous
  LinearStateMatrix a = LinearStateMatrix::Zero();
  LinearInputMatrix b = LinearInputMatrix::Zero();
  LinearGustMatrix e = LinearGustMatrix::Zero();
  LinearOutputMatrix c = LinearOutputMatrix::Zero();
  Eigen::Matrix3d d = Eigen::Matrix3d::Zero();

  /// C (lambda I - A)^-1 B + D at lambda = j 2 pi f, or exp(j 2 pi f T) when sampled; f in Hz.
  [[nodiscard]] Eigen::Matrix3cd response(double frequency_hz) const;
  /// The same from the gusts, C (lambda I - A)^-1 E, 3 x 6.
  [[nodiscard]] Eigen::Matrix<std::complex<double>, 3, 6> gust_response(double frequency_hz) const;
  /// Eigenvalues of A, by magnitude, then imaginary part.
  [[nodiscard]] std::vector<std::complex<double>> poles() const;
  /// Transmission zeros of one element, cancelling pole-zero pairs removed, in the order of poles().
  [[nodiscard]] std::vector<std::complex<double>> zeros(int output, int input) const;
};

/// Jacobian of the equations of motion at trim, by automatic differentiation (exact to rounding).
LinearModel linearize(const Aircraft& aircraft, const Trim& trim);

/// Derivative of the map over one tick, flown in `steps` Runge-Kutta steps with commands and gusts held: the
/// very code that flies, differentiated. Its response is the reference G0: at 2.89 Hz it differs from the
/// continuous one by 18 % and 10 degrees, mostly the hold.
LinearModel sample(const Aircraft& aircraft, const Trim& trim, double tick_s, int steps);

/// Trim state displaced by `x`, deviations in the order of kLinearStateNames, and back.
template <typename T>
State<T> displaced(const Trim& trim, const std::array<T, kLinearStates>& x) {
  State<T> out;
  for (std::size_t i = 0; i < state::size; ++i) out[i] = T(trim.state[i]);
  const std::array<T, 4> attitude = quaternion_of(x[6], x[7] + trim.alpha_rad);
  for (std::size_t i = 0; i < 4; ++i) out[i] = attitude[i];
  for (std::size_t i = 0; i < 6; ++i) out[state::velocity + i] = out[state::velocity + i] + x[i];
  for (std::size_t i = 8; i < kLinearStates; ++i)
    out[state::propeller + i - 8] = out[state::propeller + i - 8] + x[i];
  return out;
}
template <typename T>
std::array<T, kLinearStates> displacement(const Trim& trim, const State<T>& x) {
  std::array<T, kLinearStates> out;
  const std::array<T, 2> angles = euler_of(x);
  out[6] = angles[0];
  out[7] = angles[1] - trim.alpha_rad;
  for (std::size_t i = 0; i < 6; ++i) out[i] = x[state::velocity + i] - trim.state[state::velocity + i];
  for (std::size_t i = 8; i < kLinearStates; ++i) {
    out[i] = x[state::propeller + i - 8] - trim.state[state::propeller + i - 8];
  }
  return out;
}

}  // namespace fatmc
