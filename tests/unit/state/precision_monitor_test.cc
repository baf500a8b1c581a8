#include "coordinator/state/precision_monitor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/random/random_stream.h"

namespace fatmc {
namespace {

PrecisionRule rule(double half_width) {
  PrecisionRule out;
  out.metric = "x";
  out.half_width = half_width;
  out.minimum = 10;
  return out;
}

// Rows of one cell; every seventh has no metric.
std::vector<TrialRow> rows(std::uint64_t count, std::uint32_t cell = 0) {
  std::vector<TrialRow> out;
  for (std::uint64_t i = 0; i < count; ++i) {
    RandomStream stream(TrialSeed{1, 2, cell, i}, "test");
    TrialRow row;
    row.key = {cell, i};
    if (i % 7 != 0) row.metrics = {{"x", stream.normal()}};
    out.push_back(std::move(row));
  }
  return out;
}

TEST(PrecisionMonitor, FindsTheSameNInWhateverOrderRowsArrive) {
  std::vector<TrialRow> all = rows(400);
  PrecisionMonitor in_order(rule(0.3), 1);
  for (const TrialRow& row : all) in_order.add(row);
  ASSERT_EQ(in_order.reached().size(), 1U);
  const PrecisionReached& expected = in_order.reached()[0];
  EXPECT_GT(expected.at.trials, 10U);
  EXPECT_LT(expected.at.trials, 400U);
  EXPECT_LE(expected.at.interval.high - expected.at.interval.low, 0.6);
  std::mt19937 shuffle(5);
  for (int order = 0; order < 20; ++order) {
    std::shuffle(all.begin(), all.end(), shuffle);
    PrecisionMonitor monitor(rule(0.3), 1);
    for (const TrialRow& row : all) monitor.add(row);
    ASSERT_EQ(monitor.reached().size(), 1U);
    EXPECT_EQ(monitor.reached()[0].at.trials, expected.at.trials);
    EXPECT_EQ(monitor.reached()[0].at.interval.low, expected.at.interval.low);
  }
}

TEST(PrecisionMonitor, ATrialThatIsMissingHoldsUpTheDecision) {
  const std::vector<TrialRow> all = rows(400);
  PrecisionMonitor monitor(rule(0.3), 1);
  for (const TrialRow& row : all) {
    if (row.key.repetition != 5) monitor.add(row);
  }
  EXPECT_TRUE(monitor.reached().empty());
  EXPECT_EQ(monitor.now(0).trials, 5U);
  monitor.add(all[5]);
  EXPECT_EQ(monitor.reached().size(), 1U);
}

TEST(PrecisionMonitor, EndsEachCellByItselfAndNoneBeforeTheMinimum) {
  PrecisionRule constant = rule(0.3);
  constant.metric = "failed";  // 0 in every trial: an interval of no width from the second value on
  constant.sequence.tuned_for = 10.0;  // says something at 10 values already
  PrecisionMonitor monitor(constant, 2);
  for (const TrialRow& row : rows(30, 1)) monitor.add(row);
  ASSERT_EQ(monitor.reached().size(), 1U);
  EXPECT_EQ(monitor.reached()[0].cell, 1U);
  EXPECT_EQ(monitor.reached()[0].at.trials, 10U);
  monitor.acknowledge();
  EXPECT_TRUE(monitor.reached().empty());
  EXPECT_EQ(monitor.now(0).trials, 0U);
}

TEST(PrecisionMonitor, AValueOutsideItsBoundsIsSaidAndStopsNothing) {
  PrecisionRule bounded = rule(0.3);
  bounded.sequence = {.kind = ConfidenceSequenceOptions::Kind::bernstein, .low = 0.0, .high = 1.0};
  PrecisionMonitor monitor(bounded, 1);
  for (const TrialRow& row : rows(50)) monitor.add(row);
  EXPECT_TRUE(monitor.reached().empty());
  EXPECT_NE(monitor.failure().find("outside its bounds [0, 1]"), std::string::npos) << monitor.failure();
}

}  // namespace
}  // namespace fatmc
