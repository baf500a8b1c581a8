#include "core/stats/confidence_sequence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random/random_stream.h"

namespace fatmc {
namespace {

using Kind = ConfidenceSequenceOptions::Kind;

ConfidenceSequenceOptions bernstein(double level = 0.95, double low = 0.0, double high = 1.0) {
  return {.kind = Kind::bernstein, .level = level, .low = low, .high = high};
}

// log of the Bayes factor of the t statistic by quadrature over the effect size: the integral over delta ~
// N(0, g) of the noncentral t density over the central one, without the closed form that the program inverts.
// With the right-invariant prior 1/sigma on the deviation,
//   BF = int N(delta; 0, g) [int sigma^-n-1 exp(-sum (x - mu - sigma delta)²/(2 sigma²)) dsigma] / [the same
//   at delta = 0].
double bayes_factor(const std::vector<double>& x, double mu, double g) {
  const double n = static_cast<double>(x.size());
  double square = 0.0, sum = 0.0;
  for (const double v : x) {
    square += (v - mu) * (v - mu);
    sum += v - mu;
  }
  const auto marginal = [&](double delta) {
    // Substitute s = 1/sigma: int s^(n-1) exp(-(square s² - 2 delta sum s + n delta²)/2) ds, by the
    // trapezoidal rule.
    const double scale = std::sqrt(n / square);
    double out = 0.0;
    constexpr int kSteps = 2000;
    for (int i = 1; i <= kSteps; ++i) {
      const double s = scale * 6.0 * i / kSteps;
      out += std::exp((n - 1.0) * std::log(s / scale) -
                      0.5 * (square * s * s - 2.0 * delta * sum * s + n * delta * delta) + 0.5 * n);
    }
    return out;
  };
  double top = 0.0, weight = 0.0;
  constexpr int kSteps = 2000;
  for (int i = -kSteps; i <= kSteps; ++i) {
    const double delta = 8.0 * std::sqrt(g) * i / kSteps;
    const double density = std::exp(-0.5 * delta * delta / g);
    weight += density;
    top += density * marginal(delta);
  }
  return top / weight / marginal(0.0);
}

TEST(NormalConfidenceSequence, ItsEndsAreWhereTheBayesFactorReachesOneOverAlpha) {
  const double alpha = 0.05, tuned_for = 40.0;
  ConfidenceSequence sequence({.kind = Kind::normal, .level = 1.0 - alpha, .tuned_for = tuned_for});
  const double g = (-2.0 * std::log(alpha) + std::log(1.0 - 2.0 * std::log(alpha))) / tuned_for;
  RandomStream stream(TrialSeed{1, 2, 3, 4}, "test");
  std::vector<double> values;
  for (int i = 0; i < 12; ++i) {
    values.push_back(3.0 + 0.5 * stream.normal());
    sequence.add(values.back());
  }
  ASSERT_TRUE(std::isfinite(sequence.half_width()));
  EXPECT_NEAR(alpha * bayes_factor(values, sequence.interval().low, g), 1.0, 1e-6);
  EXPECT_NEAR(alpha * bayes_factor(values, sequence.interval().high, g), 1.0, 1e-6);
}

TEST(NormalConfidenceSequence, SaysNothingUntilItCanAndShrinksLikeTheRootOfLogNOverN) {
  ConfidenceSequence sequence({.kind = Kind::normal, .tuned_for = 500.0});
  sequence.add(1.0);
  EXPECT_TRUE(std::isinf(sequence.half_width()));
  RandomStream stream(TrialSeed{1, 2, 3, 5}, "test");
  for (int i = 1; i < 500; ++i) sequence.add(stream.normal());
  const double at_500 = sequence.half_width();
  // At the n it is tuned for it costs about 1.5 times the width of the ordinary interval.
  EXPECT_NEAR(at_500 / (1.96 / std::sqrt(500.0)), 1.5, 0.15);
}

TEST(NormalConfidenceSequence, MovesAndScalesWithItsValues) {
  ConfidenceSequence one({.kind = Kind::normal}), other({.kind = Kind::normal});
  RandomStream stream(TrialSeed{1, 2, 3, 6}, "test");
  for (int i = 0; i < 50; ++i) {
    const double x = stream.normal();
    one.add(x);
    other.add(1000.0 + 2.0 * x);
  }
  EXPECT_NEAR(other.interval().low, 1000.0 + 2.0 * one.interval().low, 1e-10);
  EXPECT_NEAR(other.half_width(), 2.0 * one.half_width(), 1e-10);
}

// The supermartingale behind the interval: for a two-point law the expectation of its next factor is a sum of
// two terms.
TEST(BernsteinConfidenceSequence, TheFactorOfOneStepHasAnExpectationOfAtMostOne) {
  for (double mean = 0.02; mean < 1.0; mean += 0.07) {
    for (double centre = 0.0; centre <= 1.0; centre += 0.1) {
      for (double lambda = 0.05; lambda <= 0.5; lambda += 0.05) {
        const auto factor = [&](double x) {
          return std::exp(lambda * (x - mean) -
                          (x - centre) * (x - centre) * (-std::log1p(-lambda) - lambda));
        };
        EXPECT_LE(mean * factor(1.0) + (1.0 - mean) * factor(0.0), 1.0 + 1e-15);
      }
    }
  }
}

TEST(BernsteinConfidenceSequence, HasTheFirstIntervalOfTheFormula) {
  ConfidenceSequence sequence(bernstein());
  EXPECT_EQ(sequence.interval().low, 0.0);
  EXPECT_EQ(sequence.interval().high, 1.0);
  // After one value x: lambda = min(1/2, sqrt(2 log 40/(0.25 log 2))) = 1/2, penalty (x - 1/2)² (log 2 -
  // 1/2).
  sequence.add(1.0);
  const double half = (std::log(40.0) + 0.25 * (std::log(2.0) - 0.5)) / 0.5;
  EXPECT_EQ(sequence.interval().low, std::max(0.0, 1.0 - half));
  EXPECT_EQ(sequence.interval().high, 1.0);
}

TEST(BernsteinConfidenceSequence, NarrowsFasterForValuesThatScatterLess) {
  ConfidenceSequence wide(bernstein()), narrow(bernstein());
  RandomStream stream(TrialSeed{1, 2, 3, 7}, "test");
  for (int i = 0; i < 1000; ++i) {
    const double u = stream.uniform();
    wide.add(u < 0.5 ? 0.0 : 1.0);
    narrow.add(0.5 + 0.05 * (u - 0.5));
  }
  EXPECT_LT(narrow.half_width(), 0.3 * wide.half_width());
  EXPECT_LE(wide.interval().low, 0.5);
  EXPECT_GE(wide.interval().high, 0.5);
}

TEST(BernsteinConfidenceSequence, KnowsItsBounds) {
  ConfidenceSequence unit(bernstein()), scaled(bernstein(0.95, -2.0, 6.0));
  RandomStream stream(TrialSeed{1, 2, 3, 8}, "test");
  for (int i = 0; i < 200; ++i) {
    const double u = stream.uniform();
    unit.add(u);
    scaled.add(-2.0 + 8.0 * u);
  }
  EXPECT_NEAR(scaled.interval().low, -2.0 + 8.0 * unit.interval().low, 1e-12);
  EXPECT_NEAR(scaled.interval().high, -2.0 + 8.0 * unit.interval().high, 1e-12);
}

}  // namespace
}  // namespace fatmc
