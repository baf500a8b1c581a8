#include "core/ident/joint_distance.h"

#include <Eigen/Cholesky>

#include "core/base/check.h"

namespace fatmc {

std::optional<double> joint_distance(const FrmEstimate& e, int k,
                                     const Eigen::Ref<const Eigen::MatrixXcd>& response) {
  FATMC_CHECK(response.rows() == e.n_out && response.cols() == e.n_in, "n_out x n_in");
  if (e.status[static_cast<std::size_t>(k)] != LineStatus::ok || e.element_variance.count() > 0 ||
      e.q < e.n_out) {
    return std::nullopt;
  }
  for (int j = 0; j < e.n_in; ++j) {
    if (!e.holds(k, j)) return std::nullopt;
  }
  // With C_V = L_C L_C^H and B^T = L_B L_B^H, T^2 = |L_C^-1 E L_B^-H|^2.
  const Eigen::LLT<Eigen::MatrixXcd> c_v(Eigen::MatrixXcd(e.C_V[k]));
  const Eigen::LLT<Eigen::MatrixXcd> b(Eigen::MatrixXcd(e.B[k].transpose()));
  if (c_v.info() != Eigen::Success || b.info() != Eigen::Success) return std::nullopt;
  const Eigen::MatrixXcd left = c_v.matrixL().solve(Eigen::MatrixXcd(e.G[k] - response));
  return b.matrixL().solve(Eigen::MatrixXcd(left.adjoint())).squaredNorm();
}

}  // namespace fatmc
