#include "campaigns/base/verdict.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "campaigns/base/figure.h"
#include "core/stats/intervals.h"

namespace fatmc {
namespace {

TableRow judged(double published, double value, double low, double high) {
  TableRow row = table_row("T", "r", "q", "Hz");
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

TEST(FillShare, IsTheBetaBinomialPrediction) {
  TableRow row = table_row("T", "r", "q", "%");
  fill_share(row, 13, 50, 50);
  EXPECT_DOUBLE_EQ(row.value, 26.0);
  // scipy.stats.betabinom(50, 13.5, 37.5).ppf([0.025, 0.975]) = 5, 22
  EXPECT_DOUBLE_EQ(row.low, 10.0);
  EXPECT_DOUBLE_EQ(row.high, 44.0);
}

TEST(FillShare, HoldsAllOrNoneWhereTheyAreLikely) {
  TableRow all = table_row("T", "r", "q", "%"), none = table_row("T", "r", "q", "%");
  fill_share(all, 4950, 5000, 50);  // 0.99^50 = 0.61
  fill_share(none, 50, 5000, 50);
  EXPECT_DOUBLE_EQ(all.high, 100.0);
  EXPECT_DOUBLE_EQ(none.low, 0.0);
}

TEST(ClampInterval, MakesNoIntervalOfNone) {
  TableRow row = judged(50.0, 60.0, std::nan(""), std::nan("")), other = judged(50.0, 60.0, -5.0, 105.0);
  clamp_interval(row, 0.0, 100.0);
  clamp_interval(other, 0.0, 100.0);
  judge_by_order(row, "because");
  EXPECT_EQ(row.verdict, "");
  EXPECT_EQ(other.low, 0.0);
  EXPECT_EQ(other.high, 100.0);
}

TEST(Verdict, OfDecibelsAsksForTenDecibels) {
  TableRow far = judged(-17.0, -32.5, -33.0, -32.0), near = judged(-17.0, -25.0, -26.0, -24.0);
  far.unit = near.unit = "dB";
  judge_by_order(far, "because");
  judge_by_order(near, "because");
  EXPECT_EQ(far.verdict, "differs");
  EXPECT_EQ(near.verdict, "shape");
}

TEST(FillStatistic, OfARatioIsPositiveAndOfAScatteredAngleHasNoInterval) {
  const std::vector<double> runs = {0.1, 5.0, 0.2, 8.0, 0.1, 9.0, 0.3, 7.0, 0.2};
  const std::vector<double> turn = {0.0, 170.0, -170.0, 90.0, -90.0, 120.0, -120.0, 10.0, 179.0};
  const auto first = [](const std::vector<double>& values) {
    return [&values](std::span<const std::size_t> picks) { return values[picks.front()]; };
  };
  TableRow ratio = table_row("T", "r", "q", ""), angle = table_row("T", "r", "q", "deg");
  fill_statistic(ratio, runs.size(), 1, first(runs), StatisticScale::ratio);
  EXPECT_GT(ratio.low, 0.0);
  fill_statistic(angle, turn.size(), 1, first(turn), StatisticScale::angle_deg);
  EXPECT_TRUE(std::isnan(angle.low));
  EXPECT_NE(angle.why, "");
}

TEST(FillStatistic, OfFewRunsHasNoInterval) {
  TableRow row = table_row("T", "r", "q", "");
  fill_statistic(row, kFewestRuns - 1, 4, [](std::span<const std::size_t>) { return 1.0; });
  EXPECT_EQ(row.value, 1.0);
  EXPECT_TRUE(std::isnan(row.low));
}

TEST(FillExtreme, IsThatOfBlocksOfThePublishedSizeAndSaysWhatItsIntervalIsWorth) {
  const std::vector<double> runs = {4.0, 3.0, 9.0, 5.0, 6.0, 7.0, 8.0, 1.0, 2.0};
  const RunStatistic smallest = [&](std::span<const std::size_t> picks) {
    double out = runs[picks.front()];
    for (const std::size_t pick : picks) out = std::min(out, runs[pick]);
    return out;
  };
  const auto filled = [&](std::size_t published_runs) {
    TableRow row = judged(3.0, 0.0, 0.0, 0.0);
    fill_extreme(row, runs.size(), published_runs, smallest, "80 to 90");
    return row;
  };
  EXPECT_DOUBLE_EQ(filled(4).value, (3.0 + 1.0) / 2.0);  // the ninth run fills no block
  EXPECT_DOUBLE_EQ(filled(9).value, 1.0);
  EXPECT_NE(filled(9).why.find("hold 80 to 90 %"), std::string::npos);
  EXPECT_DOUBLE_EQ(filled(50).value, 1.0);
  EXPECT_NE(filled(50).why.find("of 9 runs lies further out than one of 50"), std::string::npos);
  TableRow unprinted = table_row("T", "r", "q", "");
  fill_extreme(unprinted, runs.size(), 50, smallest, "80 to 90");
  EXPECT_EQ(unprinted.why, "");
}

TEST(FillStatistic, HasTheValueOfAllRuns) {
  const std::vector<double> runs = {1.0, 2.0, 3.0, 4.0, 1.0, 2.0, 3.0, 4.0};
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
