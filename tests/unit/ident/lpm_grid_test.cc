#include "core/ident/lpm_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "tests/unit/ident/synthetic_experiment.h"

namespace fatmc {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using namespace test;

std::vector<int> bins(const LpmGrid& grid, int k) {
  const auto span = grid.transient().bins(k);
  return {span.begin(), span.end()};
}

TEST(LpmGrid, TakesTheNearestNonExcitedBinsOnEachSide) {
  const LpmGrid grid = make_grid(consecutive_lines(57, 73), 3);
  EXPECT_THAT(bins(grid, 20), ElementsAre(145, 147, 149, 151, 153, 155, 157, 159, 161, 163));  // around 154
  const LpmGrid sparse = make_grid({57, 64, 71, 78, 85}, 1, {.n_e = 2});
  EXPECT_THAT(bins(sparse, 2), ElementsAre(137, 138, 139, 140, 141, 143, 144, 145, 146, 147));  // around 142
}

TEST(LpmGrid, ShiftsTransientWindowsInsideTheExcitedBand) {
  const LpmGrid grid = make_grid(consecutive_lines(57, 73), 3);
  EXPECT_THAT(bins(grid, 0), ElementsAre(113, 115, 117, 119, 121, 123, 125, 127, 129, 131));  // 2*57 - 1 is the first
  EXPECT_EQ(bins(grid, 72).back(), 2 * 129 + 1);
  EXPECT_EQ(grid.bin_count(), 2 * 129 + 2);
  const LpmGrid nine = make_grid(consecutive_lines(41, 30), 1, {.n_e = 3}, 9);
  EXPECT_THAT(bins(nine, 0), ElementsAre(364, 365, 366, 367, 368, 370, 371, 372, 373, 374));
}

TEST(LpmGrid, ShiftsWindowsOfLinesAtTheEnds) {
  const LpmGrid grid = make_grid(consecutive_lines(57, 73), 3);
  EXPECT_EQ(grid.first(0), 0);
  EXPECT_EQ(grid.first(9), 0);
  EXPECT_EQ(grid.first(10), 1);
  EXPECT_EQ(grid.first(72), 73 - 19);
  EXPECT_TRUE(grid.border(8));
  EXPECT_FALSE(grid.border(9));
  EXPECT_FALSE(grid.border(63));
  EXPECT_TRUE(grid.border(64));
  EXPECT_NEAR(grid.offsets_hz(20).front(), -0.045, 1e-15);
}

TEST(LpmGrid, HasTenDegreesOfFreedomForThreeInputs) {
  const LpmGrid grid = make_grid(consecutive_lines(57, 73), 3);
  EXPECT_EQ(grid.q(), 10);
  EXPECT_EQ(grid.q_noise(), 7);
}

TEST(LpmGrid, TransientWeightsReproducePolynomialsAndResidualsIgnoreThem) {
  const LpmGrid grid = make_grid(consecutive_lines(57, 73), 3);
  for (const int k : {0, 5, 40, 72}) {
    for (int degree = 0; degree <= 2; ++degree) {
      double value = 0.0;
      for (int i = 0; i < 10; ++i) {
        value += grid.transient().weights(k)[static_cast<std::size_t>(i)] *
                 std::pow(bins(grid, k)[static_cast<std::size_t>(i)] - grid.bin(k), degree);
      }
      EXPECT_NEAR(value, degree == 0 ? 1.0 : 0.0, 1e-10);
      for (int r = 0; r < 7; ++r) {
        double residual = 0.0;
        for (int i = 0; i < 10; ++i) {
          residual += grid.transient().complement(k)[static_cast<std::size_t>(10 * r + i)] *
                      std::pow((bins(grid, k)[static_cast<std::size_t>(i)] - grid.bin(k)) / 20.0, degree);
        }
        EXPECT_NEAR(residual, 0.0, 1e-13);
      }
    }
  }
}

TEST(LpmGrid, RefusesWhatLeavesNoDegreeOfFreedom) {
  const auto message = [](std::vector<int> lines, LpmOptions options, int periods, int n_in) {
    const auto grid = LpmGrid::create({std::move(lines), 10'000, periods, 50.0}, options, n_in);
    return grid ? std::string("accepted") : grid.error().text();
  };
  EXPECT_THAT(message(consecutive_lines(57, 73), {.n_e = 4}, 2, 3), HasSubstr("n_E >= 5"));
  EXPECT_EQ(message(consecutive_lines(57, 73), {.n_e = 5}, 2, 3), "accepted");
  EXPECT_THAT(message(consecutive_lines(57, 18), {}, 2, 1), HasSubstr("wider than the 18"));
  EXPECT_THAT(message(consecutive_lines(57, 73), {.n_transient = 1}, 2, 3), HasSubstr("take 2 or more"));
  EXPECT_THAT(message(consecutive_lines(57, 73), {}, 1, 3), HasSubstr("at least 2 whole periods"));
  EXPECT_THAT(message({5, 4}, {}, 2, 1), HasSubstr("out of order"));
  EXPECT_THAT(message({4999, 5000}, {}, 2, 1), HasSubstr("outside"));
  EXPECT_THAT(message(consecutive_lines(57, 3), {.n_e = 1, .order = 0}, 2, 1), HasSubstr("fewer than 10"));
}

}  // namespace
}  // namespace fatmc
