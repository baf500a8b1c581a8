#include "core/discrepancy/residual_response.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random/random_stream.h"

namespace fatmc {
namespace {

constexpr Eigen::Index kBins = 480;

Eigen::MatrixXcd normals(Eigen::Index cols, std::uint64_t seed, std::string_view name) {
  RandomStream random({seed, name_hash("residual response"), 0, 0}, name);
  Eigen::MatrixXcd out(kBins, cols);
  for (Eigen::Index j = 0; j < cols; ++j) {
    for (Eigen::Index i = 0; i < kBins; ++i) out(i, j) = {random.normal(), random.normal()};
  }
  return out;
}

std::vector<double> grid() {
  std::vector<double> out;
  for (Eigen::Index m = 0; m < kBins; ++m) out.push_back(1.0 + 0.01 * static_cast<double>(m));
  return out;
}

/// A smooth response.
std::complex<double> coupling(double f) { return 0.3 / std::complex<double>(1.0, f / 2.0); }

TEST(ResidualResponse, FindsTheElementThatIsMissingAndItsResponse) {
  const Eigen::MatrixXcd u = normals(2, 1, "input");
  Eigen::MatrixXcd error = 0.02 * normals(2, 1, "noise");
  for (Eigen::Index m = 0; m < kBins; ++m)
    error(m, 0) += coupling(grid()[static_cast<std::size_t>(m)]) * u(m, 1);
  const auto fit = fit_residual_response(grid(), error, u, u, {});
  ASSERT_TRUE(fit);
  ASSERT_EQ(fit->elements.size(), 1u);
  EXPECT_EQ(fit->elements.front(), std::make_pair(0, 1));
  // Column of (output 0, input 1): 2 outputs an input. A value has the noise of a bin, 0.03, over those of its window.
  for (Eigen::Index m = 0; m < kBins; m += 37) {
    EXPECT_LT(std::abs(fit->response(m, 2) - coupling(grid()[static_cast<std::size_t>(m)])), 0.1);
  }
  // No more than the noise, 2 0.02^2 a bin, and four deviations of its sum.
  EXPECT_LT(fit->after[0], 2.0 * 0.02 * 0.02 * kBins * (1.0 + 4.0 / std::sqrt(static_cast<double>(kBins))));
  EXPECT_EQ(fit->after[1], fit->before[1]);
  // What is left is the noise: variance 2 0.02^2 a bin, estimated from 48 windows of 5 complex degrees of freedom.
  EXPECT_NEAR(fit->floor[0] / (2.0 * 0.02 * 0.02 * kBins), 1.0, 4.0 / std::sqrt(240.0));
  for (const ResidualPlace& place : fit->places)
    EXPECT_EQ(std::make_pair(place.output, place.input), std::make_pair(0, 1));
}

TEST(ResidualResponse, ClosesTheErrorOfAnotherRecord) {
  const Eigen::MatrixXcd u = normals(2, 1, "input"), other = normals(2, 2, "input");
  Eigen::MatrixXcd error = 0.02 * normals(2, 1, "noise"), unseen = 0.02 * normals(2, 2, "noise");
  for (Eigen::Index m = 0; m < kBins; ++m) {
    error(m, 0) += coupling(grid()[static_cast<std::size_t>(m)]) * u(m, 1);
    unseen(m, 0) += coupling(grid()[static_cast<std::size_t>(m)]) * other(m, 1);
  }
  const auto fit = fit_residual_response(grid(), error, u, u, {});
  ASSERT_TRUE(fit);
  const Eigen::MatrixXcd left = apply_residual_response(*fit, grid(), unseen, other);
  EXPECT_LT(left.col(0).squaredNorm(), 0.05 * unseen.col(0).squaredNorm());
  EXPECT_EQ((left.col(1) - unseen.col(1)).norm(), 0.0);
}

// Nothing missing: 300 errors of noise at a level of 1 % for all tests together give 3 false alarms, and four deviations of such a
// count.
TEST(ResidualResponse, RaisesNoMoreFalseAlarmsThanItsLevel) {
  int alarms = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const auto fit = fit_residual_response(grid(), normals(1, seed, "noise"), normals(1, seed, "output"),
                                           normals(2, seed, "input"), {});
    ASSERT_TRUE(fit);
    alarms += fit->places.empty() ? 0 : 1;
  }
  EXPECT_LE(alarms, 3 + 4 * std::sqrt(3.0));
}

TEST(ResidualResponse, RefusesABandThatIsTooShort) {
  const Eigen::MatrixXcd u = normals(2, 1, "input");
  const std::vector<double> all = grid();
  const std::vector<double> f(all.begin(), all.begin() + 19);
  EXPECT_FALSE(fit_residual_response(f, u.topRows(19), u.topRows(19), u.topRows(19), {}));
}

}  // namespace
}  // namespace fatmc
