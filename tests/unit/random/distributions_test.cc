// The laws by which parameters are dispersed: distribution functions by Kolmogorov and Smirnov's distance,
// moments and correlations in standard errors. Fixed seeds; the limits leave one chance in a thousand
// (distance) or 4 standard errors.
#include "core/random/distributions.h"

#include <gtest/gtest.h>

#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <functional>

#include "core/stats/empirical.h"
#include "core/stats/intervals.h"

namespace fatmc {
namespace {

constexpr std::size_t kDraws = 20'000;

// Each draw from the stream of a trial of its own, as campaigns draw.
std::vector<double> sample(const std::function<double(RandomStream&)>& draw) {
  std::vector<double> out;
  for (std::uint64_t repetition = 0; repetition < kDraws; ++repetition) {
    RandomStream stream(TrialSeed{2018, 1, 2, repetition}, "dispersion.x");
    out.push_back(draw(stream));
  }
  return out;
}

double phi(double x) { return boost::math::cdf(boost::math::normal(), x); }

// P(sqrt(n) D > 1.95) = 1e-3 for the right law.
void expect_law(const std::vector<double>& values, const std::function<double(double)>& cdf) {
  EXPECT_LT(std::sqrt(static_cast<double>(values.size())) * EmpiricalCdf(values).distance(cdf), 1.95);
}

TEST(Distributions, UniformFollowsItsLaw) {
  const auto values = sample([](RandomStream& s) { return draw_uniform(s, -1.0, 3.0); });
  expect_law(values, [](double x) { return std::clamp((x + 1.0) / 4.0, 0.0, 1.0); });
}

TEST(Distributions, NormalFollowsItsLaw) {
  const auto values = sample([](RandomStream& s) { return draw_normal(s, 2.0, 0.5); });
  expect_law(values, [](double x) { return phi((x - 2.0) / 0.5); });
}

TEST(Distributions, TheSharpnessOfTheDistanceSuffices) {
  // The same draws against a law whose mean is 0.2 deviations off: the test above can fail.
  const auto values = sample([](RandomStream& s) { return draw_normal(s, 2.0, 0.5); });
  const double distance = EmpiricalCdf(values).distance([](double x) { return phi((x - 2.1) / 0.5); });
  EXPECT_GT(std::sqrt(static_cast<double>(kDraws)) * distance, 1.95);
}

TEST(Distributions, LogNormalFollowsItsLaw) {
  const auto values = sample([](RandomStream& s) { return draw_log_normal(s, 3.0, 0.4); });
  expect_law(values, [](double x) { return phi(std::log(x / 3.0) / 0.4); });
  EXPECT_NEAR(EmpiricalCdf(values).quantile(0.5), 3.0, 4.0 * 3.0 * 0.4 * 1.2533 / std::sqrt(1.0 * kDraws));
}

TEST(Distributions, TruncatedNormalFollowsItsLawInTheMiddleAndInBothTails) {
  for (const auto& [low, high] :
       {std::pair(-0.5, 1.5), std::pair(2.0, 9.0), std::pair(-40.0, -6.0), std::pair(30.0, 30.5)}) {
    const auto values =
        sample([&](RandomStream& s) { return draw_truncated_normal(s, 0.0, 1.0, low, high); });
    const EmpiricalCdf empirical(values);
    EXPECT_GE(empirical.sorted().front(), low);
    EXPECT_LE(empirical.sorted().back(), high);
    // Complements where they keep their digits.
    const auto mass = [](double a, double b) {
      const boost::math::normal law;
      return a > 0.0 ? boost::math::cdf(complement(law, a)) - boost::math::cdf(complement(law, b))
                     : phi(b) - phi(a);
    };
    expect_law(values, [&](double x) { return mass(low, x) / mass(low, high); });
    EXPECT_NEAR(normal_probability(0.0, 1.0, low, high) / mass(low, high), 1.0, 1e-12);
  }
}

TEST(Distributions, TruncationShiftsMeanAndVarianceByTheTextbookFormula) {
  // a = -1, b = 2: mean (phi(a) - phi(b))/Z, variance 1 + (a phi(a) - b phi(b))/Z - mean²; Johnson,
  // Kotz 13.10.
  const auto density = [](double x) { return boost::math::pdf(boost::math::normal(), x); };
  const double z = phi(2.0) - phi(-1.0), mean = (density(-1.0) - density(2.0)) / z;
  const double variance = 1.0 + (-density(-1.0) - 2.0 * density(2.0)) / z - mean * mean;
  const auto values = sample([](RandomStream& s) { return draw_truncated_normal(s, 5.0, 2.0, 3.0, 9.0); });
  const RunMean runs = mean_over_runs(values);
  EXPECT_NEAR(runs.mean, 5.0 + 2.0 * mean, 4.0 * runs.standard_error);
  EXPECT_NEAR(runs.deviation * runs.deviation / (4.0 * variance), 1.0, 4.0 * std::sqrt(2.0 / kDraws));
}

TEST(Distributions, CorrelatedNormalsHaveTheirMeansDeviationsAndCorrelations) {
  const std::vector<std::vector<double>> c = {{1.0, 0.8, -0.3}, {0.8, 1.0, 0.1}, {-0.3, 0.1, 1.0}};
  const auto factor = correlation_factor(c);
  ASSERT_EQ(factor.size(), 3U);
  const std::vector<double> mean = {1.0, -2.0, 0.0}, sd = {0.5, 2.0, 1.0};
  std::vector<std::vector<double>> columns(3);
  sample([&](RandomStream& s) {
    const auto x = draw_correlated(s, mean, sd, factor);
    for (std::size_t i = 0; i < 3; ++i) columns[i].push_back((x[i] - mean[i]) / sd[i]);
    return 0.0;
  });
  for (std::size_t i = 0; i < 3; ++i) {
    expect_law(columns[i], phi);
    for (std::size_t j = 0; j < i; ++j) {
      double sum = 0.0;
      for (std::size_t n = 0; n < kDraws; ++n) sum += columns[i][n] * columns[j][n];
      // Var(x y) = 1 + rho² for standard normals.
      const double error = std::sqrt((1.0 + c[i][j] * c[i][j]) / kDraws);
      EXPECT_NEAR(sum / kDraws, c[i][j], 4.0 * error) << i << j;
    }
  }
}

TEST(Distributions, TheFactorTimesItsTransposeIsTheCorrelation) {
  const std::vector<std::vector<double>> c = {{1.0, -0.4, 0.2}, {-0.4, 1.0, 0.5}, {0.2, 0.5, 1.0}};
  const auto l = correlation_factor(c);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      double sum = 0.0;
      for (std::size_t k = 0; k < 3; ++k) sum += l[i][k] * l[j][k];
      EXPECT_NEAR(sum, c[i][j], 1e-15);
    }
  }
}

TEST(Distributions, FullCorrelationIsAllowedAndImpossibleOnesAreNot) {
  const auto full = correlation_factor({{1.0, -1.0}, {-1.0, 1.0}});
  ASSERT_EQ(full.size(), 2U);
  RandomStream stream(TrialSeed{1, 1, 1, 1}, "x");
  const auto x = draw_correlated(stream, {0.0, 0.0}, {1.0, 1.0}, full);
  EXPECT_EQ(x[0], -x[1]);
  // Two strong positive and one strong negative correlation cannot hold together.
  EXPECT_TRUE(correlation_factor({{1.0, 0.9, 0.9}, {0.9, 1.0, -0.9}, {0.9, -0.9, 1.0}}).empty());
  EXPECT_TRUE(correlation_factor({{1.0, 1.0, 0.0}, {1.0, 1.0, 0.5}, {0.0, 0.5, 1.0}}).empty());
  EXPECT_TRUE(correlation_factor({{2.0}}).empty());
}

}  // namespace
}  // namespace fatmc
