#include "core/stats/sensitivity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/random/random_stream.h"

namespace fatmc {
namespace {

TEST(AverageRanks, EqualValuesShareTheMeanOfTheirRanks) {
  EXPECT_EQ(average_ranks(std::vector{3.0, 1.0, 3.0, 2.0, 3.0}), (std::vector{4.0, 1.0, 4.0, 2.0, 4.0}));
}

TEST(RankCorrelation, IsOneForAnyIncreasingCurveAndItsSignTurns) {
  std::vector<double> x, up, down;
  for (int i = 0; i < 30; ++i) {
    x.push_back(i);
    up.push_back(std::exp(0.3 * i));
    down.push_back(-std::cbrt(i));
  }
  EXPECT_DOUBLE_EQ(rank_correlation(x, up)->value, 1.0);
  EXPECT_DOUBLE_EQ(rank_correlation(x, down)->value, -1.0);
}

TEST(RankCorrelation, HasTheTextbookValueWithoutTies) {
  // rho = 1 - 6 sum d²/(n (n² - 1)) with d = 1, 1, 0, 1, 1.
  const std::vector<double> x = {1, 2, 3, 4, 5};
  const std::vector<double> swapped = {2, 1, 3, 5, 4};
  EXPECT_NEAR(rank_correlation(x, swapped)->value, 1.0 - 6.0 * 4.0 / 120.0, 1e-15);
}

TEST(RankCorrelation, NothingCanBeSaidOfConstants) {
  const std::vector<double> x = {1, 2, 3, 4, 5}, constant(5, 2.0);
  EXPECT_FALSE(rank_correlation(x, constant));
  EXPECT_FALSE(rank_correlation(constant, x));
  EXPECT_FALSE(rank_correlation(std::vector{1.0, 2.0, 3.0}, std::vector{1.0, 2.0, 3.0}));
}

struct Sample {
  std::vector<std::vector<double>> x{3};
  std::vector<double> linear, ishigami;
};

Sample draw(std::uint64_t seed, int n) {
  Sample out;
  for (int i = 0; i < n; ++i) {
    RandomStream stream(TrialSeed{seed, 1, 1, static_cast<std::uint64_t>(i)}, "test");
    double u[3];
    for (int k = 0; k < 3; ++k) {
      u[k] = std::numbers::pi * (2.0 * stream.uniform() - 1.0);
      out.x[static_cast<std::size_t>(k)].push_back(u[k]);
    }
    out.linear.push_back(2.0 * u[0] + u[1] + std::numbers::pi / std::sqrt(3.0) * stream.normal());
    out.ishigami.push_back(std::sin(u[0]) + 7.0 * std::pow(std::sin(u[1]), 2) +
                           0.1 * std::pow(u[2], 4) * std::sin(u[0]));
  }
  return out;
}

TEST(FirstOrderShare, OfALinearModelIsItsPartOfTheVariance) {
  const Sample sample = draw(1, 4000);
  const double expected[] = {4.0 / 6.0, 1.0 / 6.0, 0.0};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto share = first_order_share(sample.x[k], sample.linear, {.resamples = 200});
    ASSERT_TRUE(share);
    // Standard error of a coefficient of determination, 2 sqrt(S) (1 - S)/sqrt(n), and 1/n^(1/2) scale at S =
    // 0.
    const double error =
        std::max(2.0 * std::sqrt(expected[k]) * (1.0 - expected[k]), 0.1) / std::sqrt(4000.0);
    EXPECT_NEAR(share->value, expected[k], 4.0 * error) << k;
  }
}

TEST(FirstOrderShare, OfIshigamisFunctionIsTheExactOne) {
  // a = 7, b = 0.1: V = a²/8 + b π⁴/5 + b² π⁸/18 + 1/2, V1 = (1 + b π⁴/5)²/2, V2 = a²/8, V3 = 0.
  const double pi4 = std::pow(std::numbers::pi, 4);
  const double v = 49.0 / 8.0 + 0.1 * pi4 / 5.0 + 0.01 * pi4 * pi4 / 18.0 + 0.5;
  const double expected[] = {0.5 * std::pow(1.0 + 0.1 * pi4 / 5.0, 2) / v, 49.0 / 8.0 / v, 0.0};
  const Sample sample = draw(2, 4000);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto share = first_order_share(sample.x[k], sample.ishigami, {.resamples = 200});
    ASSERT_TRUE(share);
    EXPECT_NEAR(share->value, expected[k],
                4.0 * std::max(2.0 * std::sqrt(expected[k]) * (1.0 - expected[k]), 0.1) / std::sqrt(4000.0))
        << k;
  }
  // The rank correlation of the second input is nothing although its share is the largest.
  EXPECT_LT(std::abs(rank_correlation(sample.x[1], sample.ishigami)->value), 4.0 / std::sqrt(4000.0));
}

TEST(FirstOrderShare, DoesNotDependOnMonotonicTransformsOfTheInput) {
  const Sample sample = draw(3, 300);
  std::vector<double> curved;
  for (const double x : sample.x[0]) curved.push_back(std::exp(3.0 * x));
  EXPECT_EQ(first_order_share(sample.x[0], sample.linear)->value,
            first_order_share(curved, sample.linear)->value);
}

TEST(FirstOrderShare, TakesInputsOfFewDistinctValues) {
  const Sample sample = draw(4, 400);
  std::vector<double> two, y;
  for (std::size_t i = 0; i < 400; ++i) {
    two.push_back(sample.x[0][i] > 0.0 ? 1.0 : 0.0);
    y.push_back(two.back() + 0.0 * sample.linear[i]);
  }
  EXPECT_NEAR(first_order_share(two, y)->value, 1.0, 1e-12);
}

TEST(FirstOrderShare, TheSameTrialsGiveTheSameInterval) {
  const Sample sample = draw(5, 200);
  const auto one = first_order_share(sample.x[0], sample.linear),
             two = first_order_share(sample.x[0], sample.linear);
  EXPECT_EQ(one->interval.low, two->interval.low);
  EXPECT_EQ(one->interval.high, two->interval.high);
  EXPECT_FALSE(first_order_share(std::vector<double>(24, 1.0), std::vector<double>(24, 1.0)));
}

}  // namespace
}  // namespace fatmc
