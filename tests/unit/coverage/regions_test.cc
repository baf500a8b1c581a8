#include "campaigns/coverage/regions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random/random_stream.h"
#include "core/stats/confidence.h"
#include "core/stats/intervals.h"

namespace fatmc::coverage {
namespace {

constexpr int kQ = 10;

// Independent elements with the exact law: e complex normal of variance 1, σ̂² a mean of q squared normals.
TrialErrors draw(RandomStream& random, std::size_t count, double bias) {
  TrialErrors out;
  const auto normal = [&] { return std::complex<double>(random.normal(), random.normal()) / std::sqrt(2.0); };
  for (std::size_t i = 0; i < count; ++i) {
    out.error.push_back(normal());
    double variance = 0.0;
    for (int k = 0; k < kQ; ++k) variance += std::norm(normal()) / kQ;
    out.variance.push_back(variance);
    out.bias.push_back(bias);
    out.bias_printed.push_back(bias);
  }
  out.sample_error = out.error;
  return out;
}

struct Shares {
  std::vector<double> element, joint, bonferroni;
};

Shares shares(Region region, double level, double bias) {
  Shares out;
  for (std::uint64_t run = 0; run < 400; ++run) {
    RandomStream random({5, 0, 0, run}, "regions");
    const TrialCoverage coverage = trial_coverage(draw(random, 9 * 50, bias), region, level, 9, kQ);
    out.element.push_back(coverage.element);
    out.joint.push_back(coverage.joint);
    out.bonferroni.push_back(coverage.bonferroni);
  }
  return out;
}

void expect_mean(const std::vector<double>& values, double expected) {
  const RunMean mean = mean_over_runs(values);
  EXPECT_NEAR(mean.mean, expected, 4.0 * mean.standard_error);
}

TEST(Regions, HoldTheirLevelWhereTheLawIsExact) {
  for (const double level : kLevels) {
    expect_mean(shares(Region::plain, level, 0.0).element, level);
    expect_mean(shares(Region::sample, level, 0.0).element, level);
  }
}

TEST(Regions, JointShareOfNineIndependentElementsIsTheNinthPower) {
  const Shares result = shares(Region::plain, 0.95, 0.0);
  expect_mean(result.joint, std::pow(0.95, 9));
  expect_mean(result.bonferroni, std::pow(1.0 - 0.05 / 9.0, 9));
}

// With b = 2σ and no bias in truth, P((|e| − 2σ)² <= x σ̂²): the rule as printed loses estimates close to the
// truth. The value is from numerical integration over |e| and σ̂ by scipy
// (tests/validation/regions_reference.py prints it).
TEST(Regions, TheRuleAsPrintedRejectsEstimatesNearTheTruth) {
  TrialErrors exact;
  exact.error = {0.0};
  exact.variance = {1.0};
  exact.bias = exact.bias_printed = {2.0};
  EXPECT_EQ(normalised_square(exact, Region::extended, 0), 0.0);
  EXPECT_EQ(normalised_square(exact, Region::extended_as_printed, 0), 4.0);
  expect_mean(shares(Region::extended_as_printed, 0.75, 2.0).element, 0.534526);
}

TEST(Regions, TheExtendedRegionHoldsAllThatTheRegionWithoutBiasHolds) {
  RandomStream random({6, 0, 0, 0}, "regions");
  const TrialErrors errors = draw(random, 1000, 0.3);
  for (std::size_t i = 0; i < errors.error.size(); ++i) {
    EXPECT_LE(normalised_square(errors, Region::extended, i), normalised_square(errors, Region::plain, i));
  }
}

}  // namespace
}  // namespace fatmc::coverage
