// Sampled nominal model that is stable by construction.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace fatmc {

/// Poles further out than this are moved onto the circle: a slow integrator-like mode that identification or
/// linearisation left at or just outside the unit circle stays where it is to eight digits.
inline constexpr double kStablePoleRadius = 1.0 - 1e-8;

/// x[n+1] = A x[n] + B u[n], y[n] = C x[n] + D u[n].
struct SampledModel {
  Eigen::MatrixXd a;  ///< n × n
  Eigen::MatrixXd b;  ///< n × n_in
  Eigen::MatrixXd c;  ///< n_out × n
  Eigen::MatrixXd d;  ///< n_out × n_in
};

struct StabilisedModel {
  SampledModel model;
  int moved_poles = 0;
  double largest_modulus = 0.0;  ///< before
};

/// Moves every pole with |z| > `radius` to radius z/|z|; all others stay. In the real Schur form A = Q T Qᵀ the diagonal
/// block of such a pole or pair is scaled by radius/|z|, which leaves the eigenvalues of the other blocks alone; with no
/// such pole A is returned as it is. Nothing where A is not square or finite, or the Schur iteration fails.
std::optional<StabilisedModel> stabilise(const SampledModel& model, double radius = kStablePoleRadius);

/// C (e^{jωT} I − A)⁻¹ B + D at f in Hz, T = 1/rate; n_out × n_in. Poles on the unit circle at f give what is not finite.
Eigen::MatrixXcd sampled_response(const SampledModel& model, double frequency_hz, double rate_hz);

/// Largest |pole| of the loop u = K (r − y), A − B (I + K D)⁻¹ K C; `controller` is n_in × n_out. Below 1: stable.
/// Nothing where I + K D is singular (no loop exists) or the eigenvalue iteration fails.
std::optional<double> closed_loop_radius(const SampledModel& model, const Eigen::Ref<const Eigen::MatrixXd>& controller);

}  // namespace fatmc
