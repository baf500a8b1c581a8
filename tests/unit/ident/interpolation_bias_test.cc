#include "core/ident/bias_reading.h"

#include <gtest/gtest.h>

#include "tests/unit/ident/synthetic_experiment.h"

namespace fatmc {
namespace {

using namespace test;

constexpr double kPeakHz = 1.0;

/// Estimate of G = gain / (1 + 2j (f - 1 Hz) / B) without noise, lines every 0.005 Hz around the peak.
FrmEstimate resonance(const LpmGrid& grid, double b_3db_hz, double gain = 1.0) {
  RandomStream stream({1, 0, 0, 0}, "test");
  const Response g = [=](double f) {
    return Eigen::MatrixXcd::Constant(1, 1, gain / Complex(1.0, 2.0 * (f - kPeakHz) / b_3db_hz));
  };
  const Response one = [](double) { return Eigen::MatrixXcd::Identity(1, 1); };
  const LineSpectra reference = random_phases(grid, stream);
  const Spectra z = closed_loop(grid, reference, g, one, Eigen::MatrixXcd::Zero(2, 2), 1, stream);
  FastLpm lpm(grid, 1);
  lpm.load_spectra(z.outputs, z.inputs);
  return lpm.direct();
}

TEST(InterpolationBias, HasTheLimitConstantsOfTable23) {
  EXPECT_NEAR(limit_bias_constant(2), 3.0 / 35.0, 1e-15);
  EXPECT_NEAR(limit_bias_constant(4), 5.0 / 231.0, 1e-15);
  EXPECT_NEAR(limit_bias_constant(6), 35.0 / 6435.0, 1e-15);
  EXPECT_EQ(limit_bias_constant(3), limit_bias_constant(2));
  EXPECT_NEAR(*printed_bias_constant(2), limit_bias_constant(2), 5e-5);
  EXPECT_FALSE(printed_bias_constant(3).has_value());
}

// sum s_i y_i^(R+2) over lines evenly spaced in [-1/2, 1/2] times their count over (count - 1) tends to alpha / 2^(R+2).
TEST(InterpolationBias, ExactConstantTendsToTheLimitForManyLines) {
  for (const int order : {2, 4}) {
    const auto error = [order](int n_e) {
      const LpmGrid grid = make_grid(consecutive_lines(200 - n_e, 2 * n_e + 1), 1, {.n_e = n_e, .order = order});
      const double half_width = 0.5 * 0.005 * (2 * n_e + 1);
      return grid.bias_moment(n_e) / std::pow(half_width, order + 2) / limit_bias_constant(order) - 1.0;
    };
    EXPECT_LT(std::abs(error(80)), 2e-3);
    EXPECT_NEAR(error(40) / error(80), 4.0, 0.2) << "falls with the square of the number of lines";
  }
}

// Where the window is narrow against the peak, the error is the constant term of x^4 alone, which the formula gives with
// the true B_3dB. Appendix C.3's B_3dB comes from the complex polynomial, 1 - jx - x^2, whose drop to 1/sqrt 2 lies at
// x^2 = 1 - 1/sqrt 2 and not at 1: the estimate is larger than the error by (1 - 1/sqrt 2)^-2 = 11.7.
TEST(InterpolationBias, IsTheErrorAtANarrowPeakTimesAKnownFactor) {
  const LpmGrid grid = make_grid(consecutive_lines(160, 81), 1);
  const FrmEstimate estimate = resonance(grid, 1.0, 3.0);
  const int peak = 40;
  const double error = std::abs(estimate.G[peak](0, 0) - 3.0);
  const double drop = 1.0 - 1.0 / std::numbers::sqrt2;
  const double bias = interpolation_bias(grid, estimate)[peak](0, 0);
  EXPECT_NEAR(bias * drop * drop / error, 1.0, 0.03);
  EXPECT_NEAR(three_db_range_hz(grid, estimate)[peak](0, 0), std::sqrt(drop), 0.02);
}

TEST(InterpolationBias, OfTheVariantsDiffersByTheirConstantsAlone) {
  const LpmGrid grid = make_grid(consecutive_lines(160, 81), 1);
  const FrmEstimate estimate = resonance(grid, 0.2);
  const auto limit = interpolation_bias(grid, estimate, BiasConstant::limit);
  const auto printed = interpolation_bias(grid, estimate, BiasConstant::printed);
  const auto exact = interpolation_bias(grid, estimate);
  const double half_width = 0.5 * 0.005 * 19;
  for (int k = 0; k < grid.line_count(); ++k) {
    EXPECT_NEAR(printed[k](0, 0) / limit[k](0, 0), 0.0857 * 35.0 / 3.0, 1e-12);
    const double constants = grid.bias_moment(k) / (3.0 / 35.0 * std::pow(half_width, 4));
    EXPECT_NEAR(exact[k](0, 0) / limit[k](0, 0), constants, 1e-9 * constants);
  }
  EXPECT_GT(grid.bias_moment(0), 5.0 * grid.bias_moment(40)) << "one-sided windows at the border follow less well";
}

TEST(InterpolationBias, IsZeroForAConstantResponse) {
  const LpmGrid grid = make_grid(consecutive_lines(160, 81), 1);
  const FrmEstimate estimate = resonance(grid, 1e12);
  EXPECT_LT(interpolation_bias(grid, estimate)[40](0, 0), 1e-20);
}

TEST(BiasReading, DefaultIsTheBiasOfAnEstimate) {
  const LpmGrid grid = make_grid(consecutive_lines(160, 81), 1);
  const FrmEstimate estimate = resonance(grid, 0.2);
  const auto expected = interpolation_bias(grid, estimate);
  const auto read = interpolation_bias(grid, estimate, BiasReading{});
  for (int k = 0; k < grid.line_count(); ++k) EXPECT_NEAR(read[k](0, 0), expected[k](0, 0), 1e-10 * expected[k](0, 0));
}

// |G| = 1 - x^2/2 against Re G = 1 - x^2: half the curvature, a quarter of the power four.
TEST(BiasReading, OfTheMagnitudeIsAQuarterAtANarrowPeak) {
  const LpmGrid grid = make_grid(consecutive_lines(160, 81), 1);
  const FrmEstimate estimate = resonance(grid, 1.0);
  const int peak = 40;
  const double complex = interpolation_bias(grid, estimate)[peak](0, 0);
  const double magnitude =
      interpolation_bias(grid, estimate, {.fit = BiasReading::Fit::magnitude})[peak](0, 0);
  EXPECT_NEAR(magnitude / complex, 0.25, 0.01);
}

TEST(BiasReading, ByLineNumberDiffersOnUnevenLinesOnly) {
  constexpr BiasReading by_number{.constant = BiasConstant::limit, .distance = BiasReading::Distance::line_number};
  const LpmGrid even = make_grid(consecutive_lines(160, 81), 1);
  const FrmEstimate estimate = resonance(even, 0.2);
  const auto in_hz = interpolation_bias(even, estimate, BiasConstant::limit);
  const auto numbered = interpolation_bias(even, estimate, by_number);
  for (int k = 0; k < even.line_count(); ++k) EXPECT_NEAR(numbered[k](0, 0), in_hz[k](0, 0), 1e-9 * in_hz[k](0, 0));

  std::vector<int> lines = consecutive_lines(160, 41);
  for (int i = 1; i <= 40; ++i) lines.push_back(200 + 2 * i);
  const LpmGrid uneven = make_grid(lines, 1);
  // A straight line has no curvature over frequency, but one over numbers where the spacing changes.
  FrmEstimate slope = resonance(uneven, 0.2);
  for (int k = 0; k < uneven.line_count(); ++k) slope.G[k](0, 0) = 2.0 + (uneven.frequency_hz(k) - 1.0);
  const int change = 40;
  EXPECT_LT(interpolation_bias(uneven, slope, BiasConstant::limit)[change](0, 0), 1e-12);
  EXPECT_GT(interpolation_bias(uneven, slope, by_number)[change](0, 0), 1e-6);
}

}  // namespace
}  // namespace fatmc
