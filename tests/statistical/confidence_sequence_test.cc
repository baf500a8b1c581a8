// Do intervals that are looked at after every trial hold their level at all times at once? Runs of 2,000
// values; a run fails when its interval misses the mean at any n (from `minimum` on where the theory is
// asymptotic), which is what stopping by precision needs. An ordinary interval is run beside them to show
// what the looks cost it.
#include "core/stats/confidence_sequence.h"

#include <gtest/gtest.h>

#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <functional>

#include "core/random/random_stream.h"

namespace fatmc {
namespace {

using Kind = ConfidenceSequenceOptions::Kind;

constexpr int kRuns = 1000;
constexpr int kLength = 2000;
constexpr double kAlpha = 0.05;
// Of a share of kAlpha in kRuns: 0.0069.
const double kError = std::sqrt(kAlpha * (1.0 - kAlpha) / kRuns);

using Draw = std::function<double(RandomStream&)>;

/// Share of runs that miss the mean at some n >= `minimum`.
double missed(const ConfidenceSequenceOptions& options, const Draw& draw, double mean, int minimum) {
  int misses = 0;
  for (int run = 0; run < kRuns; ++run) {
    RandomStream stream(TrialSeed{9, 1, 1, static_cast<std::uint64_t>(run)}, "test");
    ConfidenceSequence sequence(options);
    for (int n = 1; n <= kLength; ++n) {
      sequence.add(draw(stream));
      if (n < minimum) continue;
      if (sequence.interval().low > mean || sequence.interval().high < mean) {
        ++misses;
        break;
      }
    }
  }
  return misses / double(kRuns);
}

double normal(RandomStream& stream) { return stream.normal(); }
double exponential(RandomStream& stream) { return -std::log1p(-stream.uniform()); }

void say(const char* what, double share) {
  std::printf("%s: %.1f %% of %d runs miss\n", what, 100.0 * share, kRuns);
}

TEST(ConfidenceSequences, NormalIsExactForNormalValuesFromTheSecondOn) {
  const double share = missed({.kind = Kind::normal}, normal, 0.0, 2);
  say("normal values", share);
  EXPECT_LE(share, kAlpha + 3.0 * kError);
  EXPECT_GT(share, 0.0) << "an interval that never misses is too wide";
}

TEST(ConfidenceSequences, NormalIsNearlyRightForSkewedValuesFromTheMinimumOn) {
  const double share = missed({.kind = Kind::normal}, exponential, 1.0, 20);
  say("exponential values from n = 20", share);
  // Asymptotic only: 2 points beyond the level are allowed for.
  EXPECT_LE(share, kAlpha + 0.02 + 3.0 * kError);
}

TEST(ConfidenceSequences, BernsteinHoldsForSharesNearOneAndForFairCoins) {
  for (const double p : {0.5, 0.95, 0.999}) {
    const auto coin = [p](RandomStream& stream) { return stream.uniform() < p ? 1.0 : 0.0; };
    const double share = missed({.kind = Kind::bernstein}, coin, p, 1);
    std::printf("p = %g: ", p);
    say("bernstein", share);
    EXPECT_LE(share, kAlpha + 3.0 * kError);
  }
}

TEST(ConfidenceSequences, AnOrdinaryIntervalLookedAtAfterEveryTrialDoesNotHold) {
  int misses = 0;
  const double quantile = boost::math::quantile(boost::math::normal(), 1.0 - 0.5 * kAlpha);
  for (int run = 0; run < kRuns; ++run) {
    RandomStream stream(TrialSeed{9, 1, 1, static_cast<std::uint64_t>(run)}, "test");
    double sum = 0.0;
    for (int n = 1; n <= kLength; ++n) {
      sum += stream.normal();
      if (n >= 20 && std::abs(sum) > quantile * std::sqrt(double(n))) {
        ++misses;
        break;
      }
    }
  }
  say("ordinary interval of known deviation", misses / double(kRuns));
  EXPECT_GT(misses / double(kRuns), 3.0 * kAlpha);
}

}  // namespace
}  // namespace fatmc
