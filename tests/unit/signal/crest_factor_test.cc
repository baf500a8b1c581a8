#include "core/signal/crest_factor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/signal/phase_correlation.h"

namespace fatmc {
namespace {

std::vector<int> table_5_1() { return lines_from_ranges(table_5_1_ranges(), 0.005).value(); }

std::vector<int> consecutive(int first, int count) {
  std::vector<int> lines;
  for (int i = 0; i < count; ++i) lines.push_back(first + i);
  return lines;
}

TEST(LowCrest, HalvesTheCrestFactorOfRandomPhasesOnTable51) {
  RandomStream stream({3, 0, 0, 0}, "crest");
  const Multisine random = Multisine::random_phase(10'000, table_5_1(), 0.03, stream);
  const LowCrest low = lower_crest_factor(random);
  EXPECT_GT(low.start, 3.0);
  EXPECT_LT(low.crest_factor, 1.95);  // clipping needs a thousand transforms for that
  EXPECT_EQ(low.signal.lines(), random.lines());
  EXPECT_EQ(low.signal.amplitudes(), random.amplitudes());
  EXPECT_NEAR(crest_factor(low.signal.period()), low.crest_factor, 1e-12);
  EXPECT_EQ(lower_crest_factor(random).signal.phases(), low.signal.phases());
}

TEST(LowCrest, LeavesASingleCosineAsItIs) {
  const LowCrest low = lower_crest_factor(Multisine(100, {3}, {2.0}, {0.4}));
  EXPECT_NEAR(low.crest_factor, std::numbers::sqrt2, 2e-3);
  EXPECT_LE(low.crest_factor, low.start);
}

TEST(LowCrest, WorksUpToHalfTheRateAndWithSilentLines) {
  // Sums of lines reach beyond half the period: W(k + l) is mirrored there.
  RandomStream stream({4, 0, 0, 0}, "crest");
  std::vector<double> amplitudes(40, 1.0);
  amplitudes[5] = 0.0;
  const Multisine random = Multisine::random_phase(101, consecutive(10, 40), amplitudes, stream);
  const LowCrest low = lower_crest_factor(random);
  EXPECT_LT(low.crest_factor, 0.7 * low.start);
  const LowCrest silent = lower_crest_factor(Multisine(100, {3, 4}, {0.0, 0.0}, {0.1, 0.2}));
  EXPECT_EQ(silent.crest_factor, 0.0);
  EXPECT_EQ(silent.signal.phases(), (std::vector<double>{0.1, 0.2}));
}

TEST(Schroeder, IsLowOnAFlatSpectrumOfConsecutiveLines) {
  const Multisine signal = schroeder_phases(4'096, consecutive(1, 31), std::vector<double>(31, 1.0));
  EXPECT_NEAR(crest_factor(signal.period()), 1.7, 0.1);  // Schroeder 1970
}

TEST(Zippered, LinesAreSharedWithoutOverlap) {
  const std::vector<int> lines = table_5_1();
  std::vector<int> all;
  for (int input = 0; input < 3; ++input) {
    const std::vector<int> own = zippered_lines(lines, input, 3);
    EXPECT_EQ(own.front(), lines[static_cast<std::size_t>(input)]);
    EXPECT_GE(own.size(), 24U);
    all.insert(all.end(), own.begin(), own.end());
  }
  std::sort(all.begin(), all.end());
  EXPECT_EQ(all, lines);
}

TEST(PhaseCorrelation, IsOneForPhasesThatGoTogether) {
  RandomStream stream({5, 0, 0, 0}, "phases");
  std::vector<double> x, same, mirrored;
  for (int i = 0; i < 73; ++i) {
    x.push_back(2.0 * std::numbers::pi * stream.uniform());
    same.push_back(x.back() + 1.0);
    mirrored.push_back(1.0 - x.back());
  }
  const PhaseCorrelation together = phase_correlation(x, same), against = phase_correlation(x, mirrored);
  EXPECT_NEAR(together.rho, 1.0, 1e-12);
  EXPECT_NEAR(together.difference, 1.0, 1e-12);
  EXPECT_LT(together.p_rho, 1e-6);
  EXPECT_LT(together.p_difference, 1e-12);
  EXPECT_NEAR(against.rho, -1.0, 1e-12);
  EXPECT_LT(against.difference, 0.5);
}

TEST(PhaseCorrelation, RejectsIndependentPhasesAsOftenAsItsLevelSays) {
  RandomStream stream({6, 0, 0, 0}, "phases");
  const int trials = 4'000;
  int rho = 0, difference = 0;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<double> x(73), y(73);
    for (auto* phases : {&x, &y}) {
      for (double& phase : *phases) phase = 2.0 * std::numbers::pi * stream.uniform();
    }
    const PhaseCorrelation c = phase_correlation(x, y);
    rho += c.p_rho < 0.05 ? 1 : 0;
    difference += c.p_difference < 0.05 ? 1 : 0;
  }
  const double band = 3.0 * std::sqrt(0.05 * 0.95 / trials);
  EXPECT_NEAR(static_cast<double>(rho) / trials, 0.05, band);
  EXPECT_NEAR(static_cast<double>(difference) / trials, 0.05, band);
}

}  // namespace
}  // namespace fatmc
