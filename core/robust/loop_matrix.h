// M-Δ structure of a loop whose plant is known to within a disc an element, and its H∞ value (T section 2.8.1).
//
// Plant G (n_out × n_in), elements G_ij + w_ij δ_ij with |δ_ij| ≤ 1, under u = K (r − y). With X = (I + K G)⁻¹ K,
//   M = −W S X T,  S = I_in ⊗ 1_out,  T = 1_inᵀ ⊗ I_out,
// square of size n_in n_out, elements sorted by input, then output (T 2.244). In print S has a wrong third column (2.241)
// and W stands on the wrong side of S (2.251).
#pragma once

#include <Eigen/Core>

namespace fatmc {

/// X = (I + K G)⁻¹ K. `invertible` is false where I + K G is singular to working precision; X is then zero.
struct LoopMatrix {
  Eigen::MatrixXcd x;                ///< n_in × n_out
  double reciprocal_condition = 0.0;  ///< of I + K G, against the norms of what is summed
  bool invertible = false;
};
/// `plant` n_out × n_in, `controller` n_in × n_out.
LoopMatrix loop_matrix(const Eigen::Ref<const Eigen::MatrixXcd>& plant,
                       const Eigen::Ref<const Eigen::MatrixXcd>& controller);

/// The whole of M, for tests and other uncertainty structures; `radii` n_out × n_in.
Eigen::MatrixXcd uncertainty_loop(const Eigen::Ref<const Eigen::MatrixXcd>& x,
                                  const Eigen::Ref<const Eigen::MatrixXd>& radii);

/// ‖M‖∞ at one frequency (T 2.252): the same as √n_in σ_max(diag(‖w_·j‖) X), which has the size of X.
double h_infinity_value(const Eigen::Ref<const Eigen::MatrixXcd>& x, const Eigen::Ref<const Eigen::MatrixXd>& radii);

}  // namespace fatmc
