// A covariance I + F F^T with few columns in F, and its symmetric inverse root. With F^T F = V S V^T and U = F V S^(-1/2),
//
//   (I + F F^T)^(-1/2) = I - U (I - (I + S)^(-1/2)) U^T,
//
// whose square is Woodbury's I - F (I + F^T F)^-1 F^T. No n x n matrix is ever formed.
//
// It is fitted to samples that are white but for a few directions (gusts that shift a record's mean airspeed move all lines
// together). With N samples of n variables the sample covariance of white noise has eigenvalues up to (1 + sqrt(g))^2,
// g = n/N (Marchenko & Pastur 1967): only larger ones are directions. A true eigenvalue l > 1 + sqrt(g) shows as
// l (1 + g/(l - 1)) (Baik & Silverstein 2006), which is undone; that its eigenvector is turned a little is left alone:
// thresholds are calibrated on samples that the fit has not seen.
#pragma once

#include <Eigen/Core>

namespace fatmc {

class LowRankCovariance {
 public:
  LowRankCovariance() = default;
  /// I + F F^T; n x r, r may be 0, columns need not be orthogonal or independent.
  explicit LowRankCovariance(Eigen::MatrixXd factor);
  /// From samples, N x n, of mean zero; at most `most` directions.
  static LowRankCovariance fit(const Eigen::Ref<const Eigen::MatrixXd>& samples, int most);

  [[nodiscard]] const Eigen::MatrixXd& factor() const { return factor_; }
  [[nodiscard]] Eigen::Index rank() const { return factor_.cols(); }
  /// Sigma^(-1/2) B, n x m: columns of covariance Sigma become columns of covariance I.
  [[nodiscard]] Eigen::MatrixXd whiten(const Eigen::Ref<const Eigen::MatrixXd>& b) const;
  /// With further columns in F: what is uncertain by these amounts, one standard deviation each.
  [[nodiscard]] LowRankCovariance with(const Eigen::Ref<const Eigen::MatrixXd>& columns) const;

 private:
  Eigen::MatrixXd factor_;
  Eigen::MatrixXd direction_;  ///< U
  Eigen::VectorXd shrink_;     ///< 1 - (1 + S)^(-1/2)
};

}  // namespace fatmc
