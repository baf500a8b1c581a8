#include "campaigns/base/verdict.h"

#include <gtest/gtest.h>

#include <cmath>

#include "campaigns/base/figure.h"
#include "core/stats/intervals.h"

namespace fatmc {
namespace {

TableRow judged(double published, double value, double low, double high) {
  TableRow row = table_row("T", "r", "q", "dB");
  row.published = published;
  row.value = value;
  row.low = low;
  row.high = high;
  return row;
}

TEST(Verdict, IsMatchInsideTheIntervalAndGivesNoReason) {
  TableRow row = judged(2.0, 1.0, 0.5, 2.0);
  judge_by_order(row, "because");
  EXPECT_EQ(row.verdict, "match");
  EXPECT_EQ(row.why, "");
}

TEST(Verdict, IsShapeForTheSameSignAndOrderElseDiffers) {
  for (const auto& [published, verdict] : {std::pair{3.0, "shape"},
                                           {0.34, "shape"},
                                           {3.3, "differs"},
                                           {0.3, "differs"},
                                           {-1.0, "differs"},
                                           {0.0, "differs"}}) {
    TableRow row = judged(published, 1.0, 0.9, 1.1);
    judge_by_order(row, "because");
    EXPECT_EQ(row.verdict, verdict) << published;
    EXPECT_EQ(row.why, "because");
  }
}

TEST(Verdict, BySideComparesWithTheNominalValue) {
  TableRow above = judged(97.0, 92.0, 91.0, 93.0), below = judged(97.0, 88.0, 87.0, 89.0);
  judge_by_side(above, 90.0, "because");
  judge_by_side(below, 90.0, "because");
  EXPECT_EQ(above.verdict, "shape");
  EXPECT_EQ(below.verdict, "differs");
}

TEST(Verdict, IsNotGivenWithoutAnIntervalOrWithoutPrint) {
  TableRow row = judged(1.0, 1.0, std::nan(""), std::nan("")),
           unprinted = judged(std::nan(""), 1.0, 0.0, 2.0);
  judge_by_order(row, "because");
  judge_by_order(unprinted, "because");
  EXPECT_EQ(row.verdict, "");
  EXPECT_NE(row.why, "");
  EXPECT_EQ(unprinted.verdict + unprinted.why, "");
}

TEST(Verdict, IsExactToThePrintedDigits) {
  TableRow exact = judged(0.486, 0.48649, 0, 0), off = judged(0.486, 0.48651, 0, 0);
  judge_exact(exact, 0.001, "because");
  judge_exact(off, 0.001, "because");
  EXPECT_EQ(exact.verdict, "exact");
  EXPECT_EQ(off.verdict, "shape");
}

TEST(FillMean, IsThePredictionIntervalOfFurtherRunsAndLeavesOutNaN) {
  const std::vector<double> runs = {0.5, 0.7, std::nan(""), 0.6};
  TableRow row = table_row("T", "r", "q", "%");
  fill_mean(row, runs, 50, 100.0);
  const std::vector<double> finite = {0.5, 0.7, 0.6};
  const Interval interval = prediction_interval(mean_over_runs(finite), 50);
  EXPECT_NEAR(row.value, 60.0, 1e-12);
  EXPECT_NEAR(row.low, 100.0 * interval.low, 1e-12);
  EXPECT_NEAR(row.high, 100.0 * interval.high, 1e-12);
  EXPECT_EQ(row.n, 4U);
}

TEST(FillShare, IsWilsonsIntervalForTheDifferenceOfTwoShares) {
  TableRow row = table_row("T", "r", "q", "%"), endless = table_row("T", "r", "q", "%");
  fill_share(row, 13, 50, 50);
  EXPECT_DOUBLE_EQ(row.value, 26.0);
  const Interval half = proportion_interval(13, 50);
  EXPECT_LT(row.low, 100.0 * half.low);
  EXPECT_GT(row.high, 100.0 * half.high);
  fill_share(endless, 13, 50, 1'000'000'000);  // against a campaign without scatter of its own
  EXPECT_NEAR(endless.low, 100.0 * half.low, 1e-5);
  EXPECT_NEAR(endless.high, 100.0 * half.high, 1e-5);
}

TEST(FillStatistic, HasTheValueOfAllRuns) {
  const std::vector<double> runs = {1.0, 2.0, 3.0, 4.0};
  TableRow row = table_row("T", "r", "q", "dB");
  fill_statistic(row, runs.size(), 4, [&](std::span<const std::size_t> picks) {
    double sum = 0.0;
    for (const std::size_t pick : picks) sum += runs[pick];
    return sum / static_cast<double>(picks.size());
  });
  EXPECT_DOUBLE_EQ(row.value, 2.5);
  EXPECT_LT(row.low, 2.5);
  EXPECT_GT(row.high, 2.5);
}

TEST(Box, HasQuartilesWhiskersAndOutliers) {
  const auto box = plot::box_of({1.0, 2.0, 3.0, 4.0, 5.0, 100.0, std::nan(""), -50.0, 3.0});
  ASSERT_TRUE(box.has_value());
  EXPECT_DOUBLE_EQ(box->lower_quartile, 1.75);  // of -50 1 2 3 3 4 5 100
  EXPECT_DOUBLE_EQ(box->median, 3.0);
  EXPECT_DOUBLE_EQ(box->upper_quartile, 4.25);
  EXPECT_DOUBLE_EQ(box->low_whisker, 1.0);
  EXPECT_DOUBLE_EQ(box->high_whisker, 5.0);
  EXPECT_EQ(box->outliers, (std::vector<double>{-50.0, 100.0}));
  EXPECT_FALSE(plot::box_of({std::nan("")}).has_value());
}

}  // namespace
}  // namespace fatmc
