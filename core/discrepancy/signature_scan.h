// Which effects could explain a discrepancy, by the generalised likelihood ratio of their signatures.
//
// For a white vector z, directions J that are fitted already and a signature a with its part a_J orthogonal to J,
//   GLR = max(0, a_J^T z)^2 / (a_J^T a_J),   amplitude = a_J^T z / (a_J^T a_J):
// twice the gain in log-likelihood of z ~ N(J t + s a, I), s >= 0, over s = 0. (Signatures of both signs stand in the
// dictionary, so that s is not negative.) Where the model is right it is half chi-square with one degree of freedom and half
// zero.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fatmc {

struct ScanHit {
  int atom = -1;
  double glr = 0.0;
  double amplitude = 0.0;
};

/// One hit a column of `atoms`; J may have no columns. Signatures that lie within J to 1e-6 of their length have none (0).
std::vector<ScanHit> scan_signatures(const Eigen::Ref<const Eigen::VectorXd>& z,
                                     const Eigen::Ref<const Eigen::MatrixXd>& atoms,
                                     const Eigen::Ref<const Eigen::MatrixXd>& fitted);

}  // namespace fatmc
