// Do the intervals of rank correlations and variance shares hold 95 %? Samples of known truth, drawn anew.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/random/random_stream.h"
#include "core/stats/sensitivity.h"

namespace fatmc {
namespace {

constexpr int kSamples = 400;
constexpr int kTrials = 100;
// Standard error of a proportion of 0.95 in kSamples: 0.011. The interval of a share is approximate at n =
// 100: 2 points of undercoverage are allowed for beside 3 standard errors.
const double kError = std::sqrt(0.95 * 0.05 / kSamples);

struct Sample {
  std::vector<double> a, b, y;
};

// y = 2 a + b + e: shares 2/3 and 1/6. corr(a, y) = 2/sqrt(6), so that Spearman's is 6/pi asin(rho/2).
Sample draw(int index) {
  Sample out;
  for (int i = 0; i < kTrials; ++i) {
    RandomStream stream(TrialSeed{7, 1, static_cast<std::uint64_t>(index), static_cast<std::uint64_t>(i)},
                        "test");
    out.a.push_back(stream.normal());
    out.b.push_back(stream.normal());
    out.y.push_back(2.0 * out.a.back() + out.b.back() + stream.normal());
  }
  return out;
}

double spearman_of_normals(double rho) { return 6.0 / std::numbers::pi * std::asin(0.5 * rho); }

bool holds(const Interval& interval, double truth) { return interval.low <= truth && truth <= interval.high; }

TEST(SensitivityIntervals, HoldTheirLevelForALinearModel) {
  int rank_a = 0, rank_b = 0, share_a = 0, share_b = 0;
  for (int index = 0; index < kSamples; ++index) {
    const Sample sample = draw(index);
    rank_a += holds(rank_correlation(sample.a, sample.y)->interval, spearman_of_normals(2.0 / std::sqrt(6.0)))
                  ? 1
                  : 0;
    rank_b += holds(rank_correlation(sample.b, sample.y)->interval, spearman_of_normals(1.0 / std::sqrt(6.0)))
                  ? 1
                  : 0;
    const ShareOptions options{.resamples = 200};
    share_a += holds(first_order_share(sample.a, sample.y, options)->interval, 4.0 / 6.0) ? 1 : 0;
    share_b += holds(first_order_share(sample.b, sample.y, options)->interval, 1.0 / 6.0) ? 1 : 0;
  }
  std::printf("held of %d: rank correlation %d, %d; share %d, %d\n", kSamples, rank_a, rank_b, share_a,
              share_b);
  for (const int held : {rank_a, rank_b}) EXPECT_NEAR(held / double(kSamples), 0.95, 3.0 * kError);
  for (const int held : {share_a, share_b}) EXPECT_NEAR(held / double(kSamples), 0.95, 0.02 + 3.0 * kError);
}

TEST(SensitivityIntervals, AnInputWithoutInfluenceIsFoundToHaveNone) {
  int rank = 0, share = 0;
  for (int index = 0; index < kSamples; ++index) {
    const Sample sample = draw(index);
    std::vector<double> other;
    for (int i = 0; i < kTrials; ++i) {
      RandomStream stream(TrialSeed{8, 1, static_cast<std::uint64_t>(index), static_cast<std::uint64_t>(i)},
                          "test");
      other.push_back(stream.uniform());
    }
    rank += holds(rank_correlation(other, sample.y)->interval, 0.0) ? 1 : 0;
    share += holds(first_order_share(other, sample.y, {.resamples = 200})->interval, 0.0) ? 1 : 0;
  }
  std::printf("held of %d: rank correlation %d, share %d\n", kSamples, rank, share);
  EXPECT_NEAR(rank / double(kSamples), 0.95, 3.0 * kError);
  // At the edge of the range the lower end is cut to 0, so that the interval holds 0 more often than 95 %.
  EXPECT_GE(share / double(kSamples), 0.95 - 3.0 * kError);
}

}  // namespace
}  // namespace fatmc
