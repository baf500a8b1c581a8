#include "core/ident/design_formulas.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "core/ident/interpolation_bias.h"

namespace fatmc {
namespace {

TEST(DesignFormulas, SpacingAndDurationAreOnesInverse) {
  // B_3dB = 2 zeta f0, n_E = R + 1 and a bias of alpha: 1/df = (2R + 3)/(2 zeta f0).
  const double f0 = 0.33, damping = 0.18;
  EXPECT_NEAR(1.0 / required_line_spacing_hz(2.0 * damping * f0, 3, 2, limit_bias_constant(2)),
              recommended_duration_s(f0, damping, 2, DurationRule::corrected), 1e-12);
}

TEST(DesignFormulas, ATighterBiasNeedsFinerLinesByItsFourthRoot) {
  EXPECT_NEAR(required_line_spacing_hz(0.1, 9, 2, 1e-4) / required_line_spacing_hz(0.1, 9, 2, 1e-8), 10.0, 1e-12);
}

TEST(DesignFormulas, MagnitudeConstantsAreTheExpansionsCoefficients) {
  EXPECT_NEAR(magnitude_bias_constant(2), 3.0 / 35.0 * 3.0 / 8.0, 1e-16);
  EXPECT_NEAR(magnitude_bias_constant(4), 5.0 / 231.0 * 5.0 / 16.0, 1e-16);
}

TEST(Intergrid, ErrorIsWhatAResonanceMidwayBetweenLinesLoses) {
  // A second-order mode itself, of little damping, at its peak and half a spacing beside it.
  const double f0 = 2.0, damping = 0.002, spacing = 0.005;
  const auto magnitude = [&](double f) {
    return 1.0 / std::abs(std::complex<double>(f0 * f0 - f * f, 2.0 * damping * f0 * f));
  };
  EXPECT_NEAR(1.0 - magnitude(f0 + 0.5 * spacing) / magnitude(f0), intergrid_error(spacing, f0, damping), 2e-3);
}

TEST(Intergrid, CorrectedDampingLosesThreeDecibels) {
  const double damping = intergrid_damping_3db(0.005, 2.0);
  EXPECT_NEAR(intergrid_error(0.005, 2.0, damping), 1.0 - 1.0 / std::sqrt(2.0), 1e-15);
}

TEST(Intergrid, ThreePercentOnTable51CoverDampingAbove0035And021) {
  EXPECT_NEAR(intergrid_covered_damping(0.03, 0.005, 0.285), 0.035, 5e-4);
  EXPECT_NEAR(intergrid_covered_damping(0.03, 0.07, 0.65), 0.21, 5e-3);
}

TEST(Intergrid, ContourInvertsTheError) {
  const double spacing = intergrid_relative_spacing(0.05, 0.02);
  EXPECT_NEAR(intergrid_error(spacing * 3.0, 3.0, 0.02), 0.05, 1e-15);
}

}  // namespace
}  // namespace fatmc
