#include "core/discrepancy/low_rank_covariance.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/random/random_stream.h"

namespace fatmc {
namespace {

/// Orthonormal basis of the columns.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& a) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(a);
  return qr.householderQ() * Eigen::MatrixXd::Identity(a.rows(), a.cols());
}

/// l of a sample eigenvalue x = l (1 + g/(l - 1)) above the edge of white noise.
double true_eigenvalue(double x, double g) {
  const double b = x + 1.0 - g;
  return 0.5 * (b + std::sqrt(std::max(0.0, b * b - 4.0 * x)));
}

}  // namespace

LowRankCovariance::LowRankCovariance(Eigen::MatrixXd factor) : factor_(std::move(factor)) {
  const Eigen::Index r = factor_.cols();
  direction_.resize(factor_.rows(), 0);
  shrink_.resize(0);
  if (r == 0) return;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(factor_.transpose() * factor_);
  // Directions without weight (columns that depend on others) stay white.
  const double least = 1e-14 * eigen.eigenvalues()[r - 1];
  Eigen::Index first = 0;
  while (first < r && !(eigen.eigenvalues()[first] > least)) ++first;
  const Eigen::ArrayXd s = eigen.eigenvalues().tail(r - first).array();
  direction_ = factor_ * eigen.eigenvectors().rightCols(r - first) * s.rsqrt().matrix().asDiagonal();
  shrink_ = 1.0 - (1.0 + s).rsqrt();
}

// Leading eigenvectors of samples^T samples / N by subspace iteration: a few large eigenvalues stand above a bulk, so that
// the iteration needs few rounds. The start is a fixed draw: the same samples give the same bits.
LowRankCovariance LowRankCovariance::fit(const Eigen::Ref<const Eigen::MatrixXd>& samples, int most) {
  const Eigen::Index count = samples.rows(), n = samples.cols();
  FATMC_CHECK(count > 1, "samples");
  const Eigen::Index width = std::min<Eigen::Index>({n, count, most + 8});
  RandomStream random({0, name_hash("low rank covariance"), 0, 0}, "start");
  Eigen::MatrixXd basis(n, width);
  for (Eigen::Index j = 0; j < width; ++j) {
    for (Eigen::Index i = 0; i < n; ++i) basis(i, j) = random.normal();
  }
  constexpr int kRounds = 12;
  for (int round = 0; round < kRounds; ++round) {
    basis = orthonormal(samples.transpose() * (samples * orthonormal(basis)));
  }
  const Eigen::MatrixXd projected = samples * basis;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(projected.transpose() * projected /
                                                             static_cast<double>(count));
  const double g = static_cast<double>(n) / static_cast<double>(count);
  // 5 % above the edge: the largest eigenvalue of white noise scatters about it by some N^(-2/3).
  const double edge = 1.05 * (1.0 + std::sqrt(g)) * (1.0 + std::sqrt(g));
  Eigen::Index r = 0;
  while (r < std::min<Eigen::Index>(width, most) && eigen.eigenvalues()[width - 1 - r] > edge) ++r;
  Eigen::MatrixXd factor(n, r);
  for (Eigen::Index j = 0; j < r; ++j) {
    const double excess = true_eigenvalue(eigen.eigenvalues()[width - 1 - j], g) - 1.0;
    factor.col(j) = std::sqrt(excess) * (basis * eigen.eigenvectors().col(width - 1 - j));
  }
  return LowRankCovariance(std::move(factor));
}

Eigen::MatrixXd LowRankCovariance::whiten(const Eigen::Ref<const Eigen::MatrixXd>& b) const {
  if (shrink_.size() == 0) return b;
  return b - direction_ * (shrink_.asDiagonal() * (direction_.transpose() * b));
}

LowRankCovariance LowRankCovariance::with(const Eigen::Ref<const Eigen::MatrixXd>& columns) const {
  Eigen::MatrixXd factor(columns.rows(), rank() + columns.cols());
  factor << factor_, columns;
  return LowRankCovariance(std::move(factor));
}

}  // namespace fatmc
