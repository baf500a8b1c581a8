#include "core/stats/extreme_prediction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "core/random/random_stream.h"

namespace fatmc {
namespace {

/// 1 ... n: the j-th smallest is j.
std::vector<double> ranks(int n) {
  std::vector<double> out;
  for (int j = 1; j <= n; ++j) out.push_back(j);
  return out;
}

// Every choice of the places of m further values among n + m is as likely: all are counted.
TEST(SmallestPrediction, HasTheEndsThatCountingAllOrdersGives) {
  constexpr int n = 9, m = 6;
  std::vector<double> above(n + 2, 0.0);  // orders in which all further values exceed the j-th known one
  double orders = 0.0;
  for (unsigned places = 0; places < (1U << (n + m)); ++places) {
    if (std::popcount(places) != m) continue;
    orders += 1.0;
    const int before = std::countr_zero(places);  // known values below the first further one
    for (int j = 1; j <= before; ++j) above[static_cast<std::size_t>(j)] += 1.0;
  }
  for (const double level : {0.2, 0.5, 0.8, 0.95, 0.99}) {
    const double tail = (1.0 - level) / 2.0;
    double low = -INFINITY, high = INFINITY;
    for (int j = 1; j <= n; ++j) {
      const double exceeded = above[static_cast<std::size_t>(j)] / orders;
      if (1.0 - exceeded <= tail) low = j;
      if (exceeded <= tail && std::isinf(high)) high = j;
    }
    const Interval interval = smallest_prediction(ranks(n), m, level);
    EXPECT_EQ(interval.low, low) << level;
    EXPECT_EQ(interval.high, high) << level;
  }
}

TEST(SmallestPrediction, HasALowerEndFrom39TimesAsManyValuesOn) {
  EXPECT_TRUE(std::isinf(smallest_prediction(ranks(39 * 50 - 1), 50).low));
  EXPECT_EQ(smallest_prediction(ranks(39 * 50), 50).low, 1.0);
  EXPECT_EQ(smallest_prediction(ranks(50), 50).high, 6.0);  // P(min > x_(6)) = 0.0133, x_(5): 0.0281
}

// scipy: min_m is independent of mean and s, so that P(min > mean + k s) is the integral of its density times the noncentral t
// distribution of sqrt(n) (mean - x)/s at -k sqrt(n); solved for k.
TEST(NormalSmallestFactor, AgreesWithTheNoncentralT) {
  EXPECT_NEAR(normal_smallest_factor(50, 50, 0.975), -3.51968, 2e-3);
  EXPECT_NEAR(normal_smallest_factor(50, 50, 0.5), -2.22765, 2e-3);
  EXPECT_NEAR(normal_smallest_factor(50, 50, 0.025), -1.37157, 2e-3);
  EXPECT_NEAR(normal_smallest_factor(10, 10, 0.5), -1.56158, 2e-3);
  EXPECT_NEAR(normal_smallest_factor(5000, 50, 0.975), -3.28926, 2e-3);
}

TEST(NormalSmallestPrediction, HoldsTheSmallestOfFurtherNormalValuesAsOftenAsItSays) {
  constexpr int n = 20, m = 20, repetitions = 1000;
  RandomStream random(TrialSeed{2018, name_hash("extremes"), 0, 0}, "values");
  const double low = normal_smallest_factor(n, m, 0.975), high = normal_smallest_factor(n, m, 0.025);
  int held = 0;
  for (int k = 0; k < repetitions; ++k) {
    std::vector<double> known, further;
    for (int i = 0; i < n; ++i) known.push_back(5.0 + 3.0 * random.normal());
    for (int i = 0; i < m; ++i) further.push_back(5.0 + 3.0 * random.normal());
    const RunMean runs = mean_over_runs(known);
    const double smallest = *std::min_element(further.begin(), further.end());
    held +=
        smallest >= runs.mean + low * runs.deviation && smallest <= runs.mean + high * runs.deviation ? 1 : 0;
  }
  EXPECT_NEAR(held / static_cast<double>(repetitions), 0.95, 3.0 * std::sqrt(0.95 * 0.05 / repetitions));
  const std::vector<double> two = {1.0, 3.0};
  const Interval interval = normal_smallest_prediction(two, 5);
  EXPECT_LT(interval.low, interval.high);
  EXPECT_TRUE(std::isinf(normal_smallest_prediction(std::vector<double>{1.0}, 5).low));
}

}  // namespace
}  // namespace fatmc
