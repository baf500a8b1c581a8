#include <gtest/gtest.h>

#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>

#include "core/random/random_stream.h"
#include "core/stats/confidence.h"
#include "core/stats/empirical.h"
#include "core/stats/intervals.h"

namespace fatmc {
namespace {

TEST(FDistribution, ClosedFormAgreesWithBoost) {
  for (const double q : {1.0, 2.0, 7.0, 10.0, 100.0}) {
    const boost::math::fisher_f f(2.0, 2.0 * q);
    for (const double p : {1e-6, 0.01, 0.5, 0.75, 0.9, 0.95, 0.99, 0.999999}) {
      const double x = boost::math::quantile(f, p);
      EXPECT_NEAR(f_quantile_2_2q(p, q) / x, 1.0, 1e-9) << p << " " << q;
      EXPECT_NEAR(f_cdf_2_2q(x, q), p, 1e-12);
      EXPECT_NEAR(f_cdf_2_2q(f_quantile_2_2q(p, q), q), p, 1e-14);
    }
  }
  EXPECT_EQ(f_cdf_2_2q(-1.0, 10.0), 0.0);
  EXPECT_EQ(f_quantile_2_2q(0.0, 10.0), 0.0);
  EXPECT_TRUE(std::isinf(f_quantile_2_2q(1.0, 10.0)));
}

TEST(FDistribution, RadiusAndItsConfidenceAreInverse) {
  const double radius = confidence_radius(4.0, 0.95, 10.0);
  EXPECT_NEAR(confidence_of_radius(radius / 2.0, 10.0), 0.95, 1e-14);
  EXPECT_NEAR(bonferroni_level(0.95, 9), 1.0 - 0.05 / 9.0, 1e-15);
}

TEST(ProportionInterval, IsWilsons) {
  // Solutions of |p_hat - p| = z sqrt(p (1 - p) / n).
  const double z = 1.959963984540054;
  for (const auto& [hits, n] : {std::pair<std::uint64_t, std::uint64_t>{0, 4}, {1, 10}, {25, 50}, {50, 50}}) {
    const Interval interval = proportion_interval(hits, n);
    const double p_hat = static_cast<double>(hits) / static_cast<double>(n);
    for (const double p : {interval.low, interval.high}) {
      if (p == 0.0 || p == 1.0) continue;
      EXPECT_NEAR(std::abs(p_hat - p), z * std::sqrt(p * (1.0 - p) / static_cast<double>(n)), 1e-9);
    }
    EXPECT_LE(interval.low, p_hat);
    EXPECT_GE(interval.high, p_hat);
  }
  EXPECT_EQ(proportion_interval(0, 0).high, 1.0);
}

TEST(PredictionInterval, HoldsTheMeanOfFurtherRunsAsOftenAsItSays) {
  RandomStream stream({1, 0, 0, 0}, "test");
  const int trials = 4000, n = 8, m = 5;
  int inside = 0, covered = 0;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<double> values(n);
    for (double& v : values) v = 3.0 + 2.0 * stream.normal();
    double next = 0.0;
    for (int i = 0; i < m; ++i) next += (3.0 + 2.0 * stream.normal()) / m;
    const RunMean runs = mean_over_runs(values);
    const Interval prediction = prediction_interval(runs, m), mean = mean_interval(runs);
    inside += next >= prediction.low && next <= prediction.high ? 1 : 0;
    covered += mean.low <= 3.0 && 3.0 <= mean.high ? 1 : 0;
  }
  const double band = 4.0 * std::sqrt(0.95 * 0.05 / trials);
  EXPECT_NEAR(static_cast<double>(inside) / trials, 0.95, band);
  EXPECT_NEAR(static_cast<double>(covered) / trials, 0.95, band);
}

TEST(PredictionInterval, IsInfiniteForOneRun) {
  const std::vector<double> one = {1.0};
  EXPECT_TRUE(std::isinf(prediction_interval(mean_over_runs(one), 50).high));
}

TEST(RunMean, UsesTheDivisorOfAnUnbiasedVariance) {
  const std::vector<double> values = {1.0, 2.0, 3.0, 4.0};
  const RunMean runs = mean_over_runs(values);
  EXPECT_EQ(runs.mean, 2.5);
  EXPECT_NEAR(runs.deviation, std::sqrt(5.0 / 3.0), 1e-15);
  EXPECT_NEAR(runs.standard_error, std::sqrt(5.0 / 12.0), 1e-15);
}

TEST(EmpiricalCdf, CountsValuesUpToX) {
  const EmpiricalCdf cdf({3.0, 1.0, 2.0, 2.0});
  EXPECT_EQ(cdf(0.5), 0.0);
  EXPECT_EQ(cdf(1.0), 0.25);
  EXPECT_EQ(cdf(2.0), 0.75);
  EXPECT_EQ(cdf(9.0), 1.0);
  EXPECT_EQ(cdf.quantile(0.0), 1.0);
  EXPECT_EQ(cdf.quantile(0.5), 2.0);
  EXPECT_EQ(cdf.quantile(1.0), 3.0);
  EXPECT_NEAR(cdf.quantile(0.9), 2.7, 1e-15);
}

TEST(SampleQuantile, IsThatOfTheCdf) {
  const std::vector<double> values = {3.0, -1.0, 2.0, 7.0, 2.0, 5.0};
  const EmpiricalCdf cdf(values);
  for (const double p : {0.0, 0.1, 0.25, 0.5, 0.77, 1.0}) {
    std::vector<double> scratch = values;
    EXPECT_DOUBLE_EQ(sample_quantile(scratch, p), cdf.quantile(p)) << p;
  }
}

TEST(EmpiricalCdf, MeasuresItsDistanceOnBothSidesOfEachStep) {
  const EmpiricalCdf cdf({0.5});
  EXPECT_EQ(cdf.distance([](double x) { return x; }), 0.5);
  const EmpiricalCdf two({0.1, 0.2});
  EXPECT_NEAR(two.distance([](double x) { return x; }), 0.8, 1e-15);
}

}  // namespace
}  // namespace fatmc
