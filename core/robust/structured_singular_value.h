// Robust stability of a loop whose plant is known to within a disc an element.
//
// Plant G (n_out × n_in) with elements G_ij + w_ij δ_ij, |δ_ij| ≤ 1, radii w_ij ≥ 0, under u = K (r − y).
// The loop seen by the uncertainty is X = (I + K G)⁻¹ K (n_in × n_out), and (T 2.251, corrected)
//   M = −W S X T   with S = I ⊗ 1 (one row an element), T = 1ᵀ ⊗ I,
// n_in n_out square. The plant set is stable if ssv(M) < 1 (T 2.228), and if ‖M‖∞ < 1 (T 2.225), the latter being
// conservative because it forgets that M's uncertainty is diagonal.
//
// M has the rank of X, and both figures collapse to matrices of the size of X:
//   ‖D M D⁻¹‖ = σ_max(diag(a) X diag(b)),  a_j² = Σ_i w_ij² d_ij²,  b_i² = Σ_j 1/d_ij².
// For D = I that is the H∞ value. At the best D, d_ij² = s_i t_j / w_ij, hence
//   a_j² = t_j Σ_i w_ij s_i,   b_i² = (1/s_i) Σ_j w_ij / t_j,
// a convex problem in log s and log t with n_in + n_out − 2 free variables. A lower bound is the largest spectral
// radius ρ(X diag(p) W diag(q)) over unit phases p, q: the worst δ_ij has rank one in its phases. Where σ_max is simple
// at the optimum, its singular vectors are that worst case and the bounds meet: a certificate.
#pragma once

#include <Eigen/Core>

namespace fatmc {

/// X = (I + K G)⁻¹ K. `invertible` is false where I + K G is singular to working precision; X is then zero.
struct LoopMatrix {
  Eigen::MatrixXcd x;  ///< n_in × n_out
  bool invertible = false;
};
LoopMatrix loop_matrix(const Eigen::Ref<const Eigen::MatrixXcd>& plant,
                       const Eigen::Ref<const Eigen::MatrixXcd>& controller);

/// ‖M‖∞ at one frequency. `radii` is n_out × n_in.
double h_infinity_value(const Eigen::Ref<const Eigen::MatrixXcd>& x, const Eigen::Ref<const Eigen::MatrixXd>& radii);

/// Scalings from which the next frequency or epoch may start.
struct SsvScaling {
  Eigen::VectorXd log_s;  ///< n_out; empty: cold start
  Eigen::VectorXd log_t;  ///< n_in
};

struct SsvBounds {
  double upper = 0.0;
  double lower = 0.0;
  bool certified = false;  ///< bounds agree to `SsvOptions::agreement`
  int iterations = 0;      ///< evaluations of σ_max
  double gradient = 0.0;   ///< largest derivative of log σ_max at the end; not small where σ_max is multiple
};

struct SsvOptions {
  double agreement = 1e-6;    ///< relative gap below which the bounds count as equal: far below any use of ssv
  double tolerance = 1e-11;   ///< relative change of σ_max² that ends the descent; its error is of that order
  int max_iterations = 200;   ///< evaluations; a cold start takes about 15
  int phase_iterations = 40;  ///< of the lower bound, from each start
};

/// Upper and lower bound of ssv(M). Zero radii and a singular X are allowed; all inputs must be finite.
/// `scaling`, if given, is read as a start and left at the optimum.
SsvBounds structured_singular_value(const Eigen::Ref<const Eigen::MatrixXcd>& x,
                                    const Eigen::Ref<const Eigen::MatrixXd>& radii, const SsvOptions& options = {},
                                    SsvScaling* scaling = nullptr);

}  // namespace fatmc
