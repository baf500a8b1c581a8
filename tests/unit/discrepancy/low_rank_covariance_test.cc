#include "core/discrepancy/low_rank_covariance.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "core/random/random_stream.h"

namespace fatmc {
namespace {

Eigen::MatrixXd normals(Eigen::Index rows, Eigen::Index cols, std::string_view name) {
  RandomStream random({17, name_hash("low rank test"), 0, 0}, name);
  Eigen::MatrixXd out(rows, cols);
  for (Eigen::Index j = 0; j < cols; ++j) {
    for (Eigen::Index i = 0; i < rows; ++i) out(i, j) = random.normal();
  }
  return out;
}

TEST(LowRankCovariance, WhiteningTwiceIsTheInverseOfTheDenseCovariance) {
  Eigen::MatrixXd factor(30, 4);
  factor << normals(30, 3, "factor"), Eigen::VectorXd::Zero(30);
  factor.col(3) = factor.col(0) - 2.0 * factor.col(1);  // dependent columns are allowed
  const LowRankCovariance covariance(factor);
  const Eigen::MatrixXd dense = Eigen::MatrixXd::Identity(30, 30) + factor * factor.transpose();
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(30, 30);
  const Eigen::MatrixXd root = covariance.whiten(identity);
  EXPECT_LT((root - root.transpose()).norm(), 1e-12);
  EXPECT_LT((root * root * dense - identity).norm(), 1e-10);
}

TEST(LowRankCovariance, WithoutColumnsNothingChanges) {
  const LowRankCovariance covariance(Eigen::MatrixXd(5, 0));
  const Eigen::MatrixXd b = normals(5, 2, "b");
  EXPECT_EQ((covariance.whiten(b) - b).norm(), 0.0);
}

TEST(LowRankCovariance, AFurtherColumnAddsItsSquareToTheCovariance) {
  const Eigen::MatrixXd factor = normals(12, 3, "factor");
  const LowRankCovariance in_one(factor);
  const LowRankCovariance in_two = LowRankCovariance(factor.leftCols(2)).with(factor.rightCols(1));
  const Eigen::MatrixXd b = normals(12, 4, "b");
  EXPECT_LT((in_one.whiten(b) - in_two.whiten(b)).norm(), 1e-12);
}

// n = 60 variables, two directions of variance 1 + 25 and 1 + 9, N = 2000 samples. A sample eigenvalue l has the standard error
// l (2/N)^(1/2) = 3 %; four of them.
TEST(LowRankCovariance, FitFindsDirectionsAndTheirVariance) {
  constexpr int n = 60, samples = 2000;
  Eigen::MatrixXd direction = Eigen::MatrixXd::Zero(n, 2);
  direction.col(0).head(30).setConstant(1.0 / std::sqrt(30.0));
  direction.col(1).tail(30).setConstant(1.0 / std::sqrt(30.0));
  const Eigen::MatrixXd factor = direction * Eigen::Vector2d(5.0, 3.0).asDiagonal();
  const Eigen::MatrixXd x =
      normals(samples, n, "white") + normals(samples, 2, "low rank") * factor.transpose();
  const LowRankCovariance fit = LowRankCovariance::fit(x, 8);
  ASSERT_EQ(fit.rank(), 2);
  const double four_errors = 4.0 * std::sqrt(2.0 / samples);
  EXPECT_NEAR(fit.factor().col(0).squaredNorm(), 25.0, 26.0 * four_errors);
  EXPECT_NEAR(fit.factor().col(1).squaredNorm(), 9.0, 10.0 * four_errors);
  // The angle to the true direction: sin^2 is about (n/N) l/(l - 1)^2 (Paul 2007), below 1.3 % here.
  EXPECT_GT(std::abs(fit.factor().col(0).normalized().dot(direction.col(0))), std::sqrt(1.0 - 0.013));
}

TEST(LowRankCovariance, WhiteNoiseHasNoDirections) {
  EXPECT_EQ(LowRankCovariance::fit(normals(400, 200, "noise"), 8).rank(), 0);
}

}  // namespace
}  // namespace fatmc
