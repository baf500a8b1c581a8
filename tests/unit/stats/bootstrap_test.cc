#include "core/stats/bootstrap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/random/random_stream.h"

namespace fatmc {
namespace {

std::vector<double> normals(std::size_t n, std::uint64_t repetition) {
  RandomStream random({7, name_hash("bootstrap_test"), 0, repetition}, "sample");
  std::vector<double> out(n);
  for (double& value : out) value = random.normal();
  return out;
}

RunStatistic mean_of(const std::vector<double>& runs) {
  return [&runs](std::span<const std::size_t> picks) {
    double sum = 0.0;
    for (const std::size_t pick : picks) sum += runs[pick];
    return sum / static_cast<double>(picks.size());
  };
}

TEST(Bootstrap, IntervalOfAMeanIsThatOfItsStandardError) {
  const std::vector<double> runs = normals(400, 0);
  const Interval interval = bootstrap_interval(runs.size(), mean_of(runs), {.resamples = 20000});
  double square = 0.0, mean = 0.0;
  for (const double value : runs) mean += value / 400.0;
  for (const double value : runs) square += (value - mean) * (value - mean);
  const double standard_error = std::sqrt(square / 400.0 / 400.0);  // of the resampled mean: divisor n
  // A quantile of 20,000 draws at 2.5 % has a standard error of 0.019 standard deviations.
  EXPECT_NEAR((interval.high - mean) / standard_error, 1.96, 0.08);
  EXPECT_NEAR((interval.low - mean) / standard_error, -1.96, 0.08);
}

TEST(Bootstrap, PredictionAddsTheScatterOfBothCampaigns) {
  const std::vector<double> runs = normals(400, 1);
  const Interval own = bootstrap_interval(runs.size(), mean_of(runs), {.resamples = 20000});
  const Interval other = bootstrap_prediction(runs.size(), 50, mean_of(runs), {.resamples = 20000});
  EXPECT_NEAR((other.high - other.low) / (own.high - own.low), std::sqrt(1.0 + 400.0 / 50.0), 0.12);
}

TEST(Bootstrap, PredictionHoldsTheMeanOfFurtherRunsAsOftenAsItSays) {
  constexpr int kCampaigns = 600;
  int inside = 0;
  for (std::uint64_t k = 0; k < kCampaigns; ++k) {
    const std::vector<double> ours = normals(50, 100 + 2 * k), theirs = normals(50, 101 + 2 * k);
    const Interval interval = bootstrap_prediction(50, 50, mean_of(ours), {.resamples = 400});
    double mean = 0.0;
    for (const double value : theirs) mean += value / 50.0;
    inside += mean >= interval.low && mean <= interval.high ? 1 : 0;
  }
  // Resampling 50 runs loses a factor sqrt(49/50): 94.7 % expected; three standard errors of 600 campaigns are 2.7 %.
  EXPECT_NEAR(inside / static_cast<double>(kCampaigns), 0.947, 0.028);
}

TEST(Bootstrap, ASmallestValueKeepsTheBiasOfItsOwnNumberOfRuns) {
  const std::vector<double> runs = normals(2000, 2);
  const RunStatistic smallest = [&](std::span<const std::size_t> picks) {
    double low = std::numeric_limits<double>::infinity();
    for (const std::size_t pick : picks) low = std::min(low, runs[pick]);
    return low;
  };
  const Interval interval = bootstrap_prediction(runs.size(), 50, smallest);
  EXPECT_GT(interval.low, -4.5);
  EXPECT_GT(interval.high, -1.8);  // smallest of 50 normals: -2.25 on average
}

TEST(Bootstrap, OneRunSaysNothingAndEqualArgumentsGiveEqualBits) {
  const std::vector<double> runs = normals(30, 3);
  EXPECT_TRUE(std::isinf(bootstrap_interval(1, mean_of(runs)).high));
  EXPECT_TRUE(std::isinf(bootstrap_prediction(1, 50, mean_of(runs)).low));
  const Interval first = bootstrap_prediction(30, 50, mean_of(runs)),
                 again = bootstrap_prediction(30, 50, mean_of(runs));
  EXPECT_EQ(first.low, again.low);
  EXPECT_EQ(first.high, again.high);
}

TEST(Bootstrap, AStatisticThatIsMostlyUndefinedHasNoInterval) {
  int calls = 0;
  const RunStatistic rare = [&](std::span<const std::size_t>) {
    return ++calls % 3 == 0 ? 1.0 : std::numeric_limits<double>::quiet_NaN();
  };
  EXPECT_TRUE(std::isinf(bootstrap_interval(10, rare).high));
}

}  // namespace
}  // namespace fatmc
