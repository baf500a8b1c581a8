#include "core/flight/turbulence_insensitivity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/flight/dryden.h"
#include "tests/unit/flight/fat.h"

namespace fatmc {
namespace {

LinearModel sampled_fat() { return sample(fat(), trim_level(fat()), 0.02, 1); }

TEST(TurbulenceInsensitivity, IsSmallWhereTheAirframeResonates) {
  const LinearModel model = sampled_fat();
  // Dutch roll at 0.33 Hz in yaw; pitch and yaw grow with frequency, as in Figure 5-2.
  const double at_dutch_roll = turbulence_insensitivity(model, 0.33)[2];
  EXPECT_LT(at_dutch_roll, turbulence_insensitivity(model, 0.15)[2]);
  EXPECT_LT(at_dutch_roll, turbulence_insensitivity(model, 1.0)[2]);
  EXPECT_LT(turbulence_insensitivity(model, 0.5)[1], turbulence_insensitivity(model, 2.0)[1]);
}

TEST(TurbulenceInsensitivity, IsTheInverseOfWhatARotatingAirMovesInSteadyState) {
  // A sine of rotational gust through the step map, once transients are gone.
  const LinearModel model = sampled_fat();
  const int period = 100, periods = 200;  // 0.5 Hz; the phugoid's e-fold is 25 s of the 400
  Eigen::Matrix<double, kLinearStates, 1> x = Eigen::Matrix<double, kLinearStates, 1>::Zero();
  std::complex<double> sum = 0.0;
  for (int n = 0; n < period * periods; ++n) {
    const double angle = 2.0 * std::numbers::pi * n / period;
    if (n >= period * (periods - 1)) sum += std::polar(2.0 / period, -angle) * (model.c.row(1) * x)(0);
    x = model.a * x + model.e.col(4) * std::cos(angle);
  }
  EXPECT_NEAR(1.0 / std::abs(sum) / turbulence_insensitivity(model, 0.5)[1], 1.0, 1e-4);
}

TEST(TurbulenceLimitedSnr, UsesTheGustsOwnSpectrum) {
  // |T|^2 of drawn gusts at one bin, by the project's DFT, against f_s times the density behind the formula.
  const LinearModel model = sampled_fat();
  const int n = 1'000, runs = 400, bin = 10;
  const double f = bin / (n * 0.02), sigma = 0.5, amplitude = 0.02;
  const Dryden dryden(sigma, 24.0, 5.0, 0.02);
  double mean = 0.0, square = 0.0;
  for (int run = 0; run < runs; ++run) {
    RandomStream stream({1, 0, 0, static_cast<std::uint64_t>(run)}, "gusts");
    Dryden::StateVector x = dryden.start(stream);
    std::complex<double> t = 0.0;
    for (int i = 0; i < n; ++i) {
      t += std::polar(1.0 / std::sqrt(n), -2.0 * std::numbers::pi * bin * i / n) * dryden.gusts(x)[3];
      dryden.advance(x, stream);
    }
    mean += std::norm(t) / runs;
    square += std::norm(t) * std::norm(t) / runs;
  }
  const double error = std::sqrt((square - mean * mean) / runs);
  const double snr = turbulence_limited_snr(model, 0, f, amplitude, n * 0.02, sigma, 24.0, 5.0);
  const double r = 0.5 * amplitude * std::sqrt(n), s = turbulence_insensitivity(model, f)[0];
  EXPECT_NEAR(std::pow(s * r / snr, 2), mean, 3.0 * error);
  EXPECT_TRUE(std::isinf(turbulence_limited_snr(model, 0, f, amplitude, n * 0.02, 0.0, 24.0, 5.0)));
}

}  // namespace
}  // namespace fatmc
