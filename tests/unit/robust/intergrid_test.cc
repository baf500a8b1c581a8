#include "core/robust/intergrid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

namespace fatmc {
namespace {

/// |G| of a second-order resonance of unit gain, frequency in units of f_0.
double magnitude(double f, double damping) {
  return 1.0 / std::abs(std::complex<double>(1.0 - f * f, 2.0 * damping * f));
}

/// Peak over the larger of its two neighbours on a grid of that spacing with the peak midway, less one: what the larger
/// measured value still misses.
double missed(double spacing, double damping) {
  double peak = 0.0;
  for (int i = -2000; i <= 2000; ++i) peak = std::max(peak, magnitude(1.0 + 0.5 * spacing * i / 2000.0, damping));
  const double left = magnitude(1.0 - 0.5 * spacing, damping), right = magnitude(1.0 + 0.5 * spacing, damping);
  return peak / std::max(left, right) - 1.0;
}

// The relation is of first order in Δf/f_0: the lower line of a resonance is higher than the upper one, by a factor of
// about 1 + Δf/(2 f_0). Halving the spacing at a fixed ratio of spacing to damping has to halve the difference.
TEST(Intergrid, ErrorIsThatOfAResonanceMidwayToFirstOrderInTheSpacing) {
  for (const double ratio : {0.3, 1.0, 2.0, 5.0}) {  // Δf/(2 ζ f_0)
    double before = 0.0;
    for (const double spacing : {0.004, 0.002, 0.001}) {
      const double damping = spacing / (2.0 * ratio);
      const double expected = intergrid_error(spacing, damping);
      const double difference = std::abs(missed(spacing, damping) - expected);
      EXPECT_LT(difference, spacing * (1.0 + expected)) << ratio << " " << spacing;
      if (before > 0.0) {
        EXPECT_NEAR(difference / before, 0.5, 0.05) << ratio << " " << spacing;
      }
      before = difference;
    }
  }
}

TEST(Intergrid, CorrectedDampingIsMissedByThreeDecibelAndThePrintedOneByFarMore) {
  const double spacing = 0.001;
  EXPECT_NEAR(20.0 * std::log10(1.0 + missed(spacing, three_db_damping(spacing, 1.0))), 3.0103, 0.01);
  EXPECT_GT(20.0 * std::log10(1.0 + missed(spacing, printed_three_db_damping(spacing, 1.0))), 15.0);
  EXPECT_NEAR(three_db_damping(0.005, 0.3) / printed_three_db_damping(0.005, 0.3), 2.0 * 3.14159265358979, 1e-12);
}

TEST(Intergrid, ContourGivesTheExampleOfFigure235) {
  EXPECT_NEAR(covered_damping(0.005, 0.05), 0.008, 0.0005);  // printed to one digit
  EXPECT_NEAR(covered_damping(0.005 / 0.285, 0.03), 0.035, 0.001);  // Table 5-1's grid at both of its spacings
  EXPECT_NEAR(covered_damping(0.07 / 0.65, 0.03), 0.218, 0.001);
}

TEST(Intergrid, FunctionsInvertEachOther) {
  for (const double error : {1e-9, 0.03, 0.05, 0.4142, 3.0}) {
    for (const double damping : {1e-4, 0.02, 0.3}) {
      const double spacing = largest_relative_spacing(damping, error);
      EXPECT_NEAR(covered_damping(spacing, error) / damping, 1.0, 1e-12);
      EXPECT_NEAR(intergrid_error(spacing, damping) / error, 1.0, 1e-12);
    }
  }
  EXPECT_EQ(largest_relative_spacing(0.1, 0.0), 0.0);
  EXPECT_TRUE(std::isinf(covered_damping(0.01, 0.0)));
  EXPECT_EQ(covered_damping(0.0, 0.0), 0.0);
}

}  // namespace
}  // namespace fatmc
