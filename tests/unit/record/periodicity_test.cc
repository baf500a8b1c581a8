#include "core/record/periodicity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/random/random_stream.h"
#include "core/signal/multisine.h"

namespace fatmc {
namespace {

Eigen::MatrixXd excitation(int period, int periods, const std::vector<int>& lines, int channels, double noise,
                           std::uint64_t seed) {
  RandomStream stream({seed, 0, 0, 0}, "test");
  Eigen::MatrixXd x(period * periods, channels);
  for (int c = 0; c < channels; ++c) {
    const Multisine sine = Multisine::random_phase(period, lines, 1.0, stream);
    const std::vector<double> samples = sine.samples(periods);
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      x(i, c) = samples[static_cast<std::size_t>(i)] + noise * sine.rms() * stream.normal();
    }
  }
  return x;
}

TEST(FindPeriod, FindsWhatRepeatsExactly) {
  const std::vector<int> lines = lines_from_ranges(table_5_1_ranges(), 0.005).value();
  EXPECT_EQ(find_period(excitation(10'000, 2, lines, 3, 0.0, 1)), 10'000);
  EXPECT_EQ(find_period(excitation(8192, 9, {41, 42, 50, 91, 307}, 1, 0.0, 2)), 8192);
  EXPECT_EQ(find_period(excitation(997, 5, {3, 7, 8, 30}, 2, 0.0, 3)), 997);
}

TEST(FindPeriod, FindsWhatRepeatsUpToNoise) {
  std::vector<int> lines;
  for (int k = 41; k <= 307; ++k) lines.push_back(k);
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    EXPECT_EQ(find_period(excitation(2048, 6, lines, 1, 0.1, seed)), 2048) << seed;
  }
}

TEST(FindPeriod, FindsAPeriodThatDoesNotDivideTheRecord) {
  const Eigen::MatrixXd x = excitation(1000, 4, {5, 9, 40}, 1, 0.0, 4).topRows(3500);
  EXPECT_EQ(find_period(x), 1000);
}

TEST(FindPeriod, FindsNoneInNoiseOrInOnePeriod) {
  EXPECT_EQ(find_period(excitation(4000, 1, {5, 9, 40, 77}, 1, 0.0, 5)), 0);
  RandomStream stream({6, 0, 0, 0}, "test");
  Eigen::MatrixXd noise(5000, 1);
  for (auto& v : noise.reshaped()) v = stream.normal();
  EXPECT_EQ(find_period(noise), 0);
}

TEST(FindExcitedLines, FindsLinesInNoiseAndInAnyChannel) {
  const std::vector<int> lines = {41, 42, 50, 91, 307};
  EXPECT_EQ(find_excited_lines(excitation(2048, 9, lines, 1, 0.05, 7), 2048).value(), lines);
  // Two channels that excite different lines.
  Eigen::MatrixXd x(4096, 2);
  x << excitation(2048, 2, {10, 30}, 1, 0.0, 8), 1e-3 * excitation(2048, 2, {20, 40}, 1, 0.0, 9);
  EXPECT_THAT(find_excited_lines(x, 2048).value(), ::testing::ElementsAre(10, 20, 30, 40));
}

TEST(FindExcitedLines, RefusesNoise) {
  RandomStream stream({10, 0, 0, 0}, "test");
  Eigen::MatrixXd noise(4000, 1);
  for (auto& v : noise.reshaped()) v = stream.normal();
  EXPECT_FALSE(find_excited_lines(noise, 1000).has_value());
}

TEST(RepetitionError, IsTheInverseSignalToNoiseRatio) {
  std::vector<int> lines;
  for (int k = 20; k <= 200; ++k) lines.push_back(k);
  const double error = repetition_error(excitation(2000, 10, lines, 1, 0.2, 11), 2000);
  EXPECT_NEAR(error, 0.04 / 1.04, 0.002);
}

}  // namespace
}  // namespace fatmc
