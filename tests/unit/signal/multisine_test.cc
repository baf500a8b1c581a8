#include "core/signal/multisine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/signal/dft.h"

namespace fatmc {
namespace {

using ::testing::HasSubstr;

TEST(Lines, OfTable51Are73FromHarmonic57) {
  const std::vector<int> lines = lines_from_ranges(table_5_1_ranges(), 0.005).value();
  ASSERT_EQ(lines.size(), 73U);
  EXPECT_EQ(lines.front(), 57);
  EXPECT_EQ(lines[19], 76);
  EXPECT_EQ(lines[39], 116);
  EXPECT_EQ(lines.back(), 578);
}

TEST(Lines, RefuseFrequenciesBetweenHarmonics) {
  const std::vector<FrequencyRange> printed = {{0.58, 2.89, 0.7}};  // the step as printed misses 2.89 Hz
  EXPECT_THAT(lines_from_ranges(printed, 0.005).error().text(), HasSubstr("whole steps"));
  const std::vector<FrequencyRange> between = {{0.2875, 0.4, 0.005}};
  EXPECT_THAT(lines_from_ranges(between, 0.005).error().text(), HasSubstr("multiples of 0.005 Hz"));
  EXPECT_FALSE(lines_from_ranges(table_5_1_ranges(), 0.0).has_value());
}

TEST(Multisine, IsTheSumOfItsCosines) {
  RandomStream stream({1, 0, 0, 0}, "test");
  const Multisine sine = Multisine::random_phase(100, {3, 7, 20}, {1.0, 0.5, 2.0}, stream);
  const std::vector<double> x = sine.samples(2);
  ASSERT_EQ(x.size(), 200U);
  for (int n = 0; n < 200; ++n) {
    double value = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      value += sine.amplitudes()[i] *
               std::cos(2.0 * std::numbers::pi * sine.lines()[i] * n / 100.0 + sine.phases()[i]);
    }
    EXPECT_NEAR(x[static_cast<std::size_t>(n)], value, 1e-13);
  }
}

TEST(Multisine, KnowsItsOwnSpectrumAndRms) {
  RandomStream stream({2, 0, 0, 0}, "test");
  const std::vector<int> lines = lines_from_ranges(table_5_1_ranges(), 0.005).value();
  const Multisine sine = Multisine::random_phase(10'000, lines, 0.03, stream);
  const std::vector<double> x = sine.samples(2);
  std::vector<std::complex<double>> bins(10'001);
  RealDft(20'000).transform(x, bins);
  const auto spectrum = sine.spectrum(2);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_LT(std::abs(bins[static_cast<std::size_t>(2 * lines[i])] - spectrum[i]), 1e-12);
    EXPECT_LT(std::abs(bins[static_cast<std::size_t>(2 * lines[i] + 1)]), 1e-12);
  }
  EXPECT_NEAR(sine.rms(), 0.03 * std::sqrt(36.5), 1e-15);
  EXPECT_NEAR(rms(x), sine.rms(), 1e-14);
  EXPECT_GT(crest_factor(x), std::numbers::sqrt2);
}

TEST(Multisine, DrawsPhasesThatAreUniform) {
  RandomStream stream({3, 0, 0, 0}, "test");
  std::complex<double> first = 0.0, second = 0.0;
  const int n = 20'000;
  for (int i = 0; i < n; ++i) {
    const double phase = Multisine::random_phase(16, {3}, 1.0, stream).phases()[0];
    EXPECT_GE(phase, 0.0);
    EXPECT_LT(phase, 2.0 * std::numbers::pi);
    first += std::polar(1.0 / n, phase);
    second += std::polar(1.0 / n, 2.0 * phase);
  }
  EXPECT_LT(std::abs(first), 4.0 / std::sqrt(n));
  EXPECT_LT(std::abs(second), 4.0 / std::sqrt(n));
}

}  // namespace
}  // namespace fatmc
