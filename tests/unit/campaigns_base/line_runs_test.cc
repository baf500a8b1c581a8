#include "campaigns/base/line_runs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/random/random_stream.h"
#include "core/stats/empirical.h"

namespace fatmc {
namespace {

LineRuns random_runs(std::size_t runs, RandomStream& random) {
  LineRuns out;
  for (std::size_t run = 0; run < runs; ++run) {
    // Rounded, so that values repeat.
    out.add(std::vector<double>{std::floor(10.0 * random.uniform()), random.normal()});
  }
  return out;
}

TEST(SortedRuns, GiveTheQuantileOfTheRunsAsOftenAsTheyWerePicked) {
  RandomStream random({3, 0, 0, 0}, "runs");
  const LineRuns values = random_runs(17, random);
  const SortedRuns sorted(values);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<std::size_t> picks(1 + static_cast<std::size_t>(trial) % 23);
    for (std::size_t& pick : picks) pick = static_cast<std::size_t>(17.0 * random.uniform());
    const RunCounts counts(17, picks);
    for (std::size_t line = 0; line < 2; ++line) {
      std::vector<double> picked;
      for (const std::size_t run : picks) picked.push_back(values.line(line)[run]);
      for (const double p : {0.0, 0.25, 0.5, 0.9, 1.0})
        EXPECT_DOUBLE_EQ(sorted.quantile(line, p, counts), EmpiricalCdf(picked).quantile(p));
    }
  }
}

TEST(SortedRuns, HaveNoDifferenceBetweenInfinities) {
  LineRuns values;
  const double infinity = std::numeric_limits<double>::infinity();
  for (int run = 0; run < 4; ++run) values.add(std::vector<double>{infinity});
  const std::vector<std::size_t> all = {0, 1, 2, 3};
  EXPECT_EQ(SortedRuns(values).quantile(0, 0.5, RunCounts(4, all)), infinity);
  EXPECT_EQ(values.quantile(0, 0.5), infinity);
}

TEST(LineRuns, CountSharesAboveALimit) {
  LineRuns values;
  for (const double x : {0.5, 1.0, 1.5, 2.0}) values.add(std::vector<double>{x});
  EXPECT_DOUBLE_EQ(values.share_above(0, 1.0, std::vector<std::size_t>{0, 1, 2, 3}), 0.5);
  EXPECT_DOUBLE_EQ(values.share_above(0, 1.0, std::vector<std::size_t>{3, 3, 0}), 2.0 / 3.0);
}

}  // namespace
}  // namespace fatmc
