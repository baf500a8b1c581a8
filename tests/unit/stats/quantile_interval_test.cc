#include "core/stats/quantile_interval.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/random/random_stream.h"

namespace fatmc {
namespace {

std::vector<double> ranks(int n) {
  std::vector<double> out(static_cast<std::size_t>(n));
  std::iota(out.begin(), out.end(), 1.0);
  return out;
}

TEST(QuantileInterval, OfAMedianHasTheRanksOfTheSignTest) {
  // P(B <= 1) = 11/1024 and P(B <= 2) = 56/1024 for n = 10: ranks 2 and 9. For n = 25: 8 and 18.
  const Interval ten = quantile_interval(ranks(10), 0.5), more = quantile_interval(ranks(25), 0.5);
  EXPECT_EQ(ten.low, 2.0);
  EXPECT_EQ(ten.high, 9.0);
  EXPECT_EQ(more.low, 8.0);
  EXPECT_EQ(more.high, 18.0);
}

TEST(QuantileInterval, HasNoEndThatTheValuesCannotGive) {
  const Interval few = quantile_interval(ranks(5), 0.5);  // 2/32 lie outside of all five
  EXPECT_TRUE(std::isnan(few.low));
  EXPECT_TRUE(std::isnan(few.high));
  const Interval high = quantile_interval(ranks(20), 0.9);  // 0.9^20 = 12 % that none lies above
  EXPECT_FALSE(std::isnan(high.low));
  EXPECT_TRUE(std::isnan(high.high));
  EXPECT_TRUE(std::isnan(quantile_interval({}, 0.5).low));
}

TEST(QuantileInterval, HoldsTheQuantileAtLeastAsOftenAsItSays) {
  constexpr int kSets = 2000, kValues = 60;
  int held = 0;
  for (std::uint64_t set = 0; set < kSets; ++set) {
    RandomStream random({1, name_hash("quantile interval test"), 0, set}, "values");
    std::vector<double> values;
    for (int i = 0; i < kValues; ++i) values.push_back(random.uniform());
    std::sort(values.begin(), values.end());
    const Interval interval = quantile_interval(values, 0.8);
    held += interval.low <= 0.8 && 0.8 <= interval.high ? 1 : 0;
  }
  // The law is exact: the binomial between the chosen ranks, 95 % and a little more; four standard errors of 0.5 %.
  EXPECT_GT(held, 0.93 * kSets);
  EXPECT_LT(held, 0.99 * kSets);
}

}  // namespace
}  // namespace fatmc
