// The estimator study's tables and figures on rows made by hand.
#include "campaigns/estimators/summary.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "campaigns/estimators/cell_runs.h"
#include "campaigns/estimators/mean_error.h"
#include "coordinator/input/toml_file.h"

namespace fatmc::estimators {
namespace {

CampaignSpec spec_of_linear_cell() {
  CampaignSpec spec = *decode_campaign(*read_toml_resolved("campaigns/estimators/spec.toml"));
  spec.cells.resize(1);
  return spec;
}

/// Two lines, 0.2 and 0.4 Hz; every estimator errs by `percent` in magnitude at the first and not at all at the second.
TrialRow row_of(std::uint64_t repetition, double percent) {
  TrialRow row;
  row.key = {0, repetition};
  row.arrays.emplace_back(kFrequency, std::vector<double>{0.2, 0.4});
  for (const Estimator& estimator : kEstimators) {
    row.arrays.emplace_back(name_of(estimator, kErrorReal), std::vector<double>{percent / 100.0, 0.0});
    row.arrays.emplace_back(name_of(estimator, kErrorImag), std::vector<double>{0.0, 0.0});
    row.arrays.emplace_back(name_of(estimator, kVariance), std::vector<double>{1e-4, 1e-4});
    row.metrics.emplace_back(name_of(estimator, kInside90), 0.5);
    row.metrics.emplace_back(name_of(estimator, kUnnoticed), 1.0);
    row.metrics.emplace_back(name_of(estimator, kRelativeError), std::abs(percent) / 100.0 / std::sqrt(2.0));
    row.metrics.emplace_back(name_of(estimator, kCost), 1.0);
  }
  return row;
}

RowSource rows_with(std::vector<double> percents, int lost = 0) {
  return [=](std::uint32_t, const std::function<void(const TrialRow&)>& visit) {
    std::uint64_t repetition = 0;
    for (const double percent : percents) visit(row_of(repetition++, percent));
    for (int i = 0; i < lost; ++i) {
      TrialRow row;
      row.key = {0, repetition++};
      row.outcome = "diverged";
      visit(row);
    }
  };
}

TableRow find(const std::vector<TableRow>& rows, const std::string& table, const std::string& row,
              const std::string& quantity) {
  for (const TableRow& r : rows) {
    if (r.table == table && r.row == row && r.quantity == quantity) return r;
  }
  throw std::runtime_error("no row " + table + ", " + row + ", " + quantity);
}

/// +1 % and -1 % in turn, 40 runs.
std::vector<double> alternating() {
  std::vector<double> out;
  for (int i = 0; i < 40; ++i) out.push_back(i % 2 == 0 ? 1.0 : -1.0);
  return out;
}

TEST(EstimatorSummary, MeanAndRangeAreThoseOfTwentyRuns) {
  const auto rows = tables(spec_of_linear_cell(), rows_with(alternating()));
  ASSERT_TRUE(rows);
  const double up = 20.0 * std::log10(1.01), down = 20.0 * std::log10(0.99);
  const TableRow mean = find(*rows, "3-2", "ETFE", "0.2 Hz");
  EXPECT_NEAR(mean.value, std::abs(up + down) / 2.0, 1e-12);
  EXPECT_EQ(mean.n, 40U);
  EXPECT_EQ(mean.published, 0.043);
  // Deviation of 20 times each of two values, then t(0.95; 19) s / sqrt(20).
  const double s = (up - down) / 2.0 * std::sqrt(40.0 / 39.0);
  EXPECT_NEAR(find(*rows, "3-3", "ETFE", "0.2 Hz").value, 1.729132812 * s / std::sqrt(20.0), 1e-9);
  EXPECT_EQ(find(*rows, "3-3", "ETFE", "0.4 Hz").value, 0.0);
}

TEST(EstimatorSummary, LinesThatHoldTheTruthAreCountedInCampaignsOfTwenty) {
  // The first campaign has no mean error, the second a constant one of 1 %: its interval misses the truth at one line of two.
  std::vector<double> percents = alternating();
  percents.resize(20);
  percents.insert(percents.end(), 20, 1.0);
  const auto rows = tables(spec_of_linear_cell(), rows_with(percents));
  ASSERT_TRUE(rows);
  const TableRow row =
      find(*rows, "Section 3.4.1", "tLPM", "lines whose 90 % interval of the mean of 20 holds the truth");
  EXPECT_NEAR(row.value, (100.0 + 50.0) / 2.0, 1e-9);
  EXPECT_EQ(row.published, 85.0);
}

TEST(EstimatorSummary, AFailedTrialLowersSharesAndIsNamed) {
  const auto rows = tables(spec_of_linear_cell(), rows_with(std::vector<double>(30, 1.0), 10));
  ASSERT_TRUE(rows);
  const TableRow inside = find(*rows, "Section 3.4.1", "ETFE", "lines inside the MUAD limits");
  EXPECT_NEAR(inside.value, 75.0, 1e-9);
  EXPECT_NE(inside.why.find("10 trials without an estimate"), std::string::npos);
}

TEST(EstimatorSummary, ABoundThatIsPrintedIsMetFromBelow) {
  const auto low = tables(spec_of_linear_cell(), rows_with(alternating()));
  EXPECT_EQ(find(*low, "3-2", "tLPM", "0.4 Hz").verdict, "match");
  const auto high = tables(spec_of_linear_cell(), rows_with(std::vector<double>(40, 5.0)));
  EXPECT_EQ(find(*high, "3-2", "tLPM", "0.2 Hz").verdict, "differs");
}

TEST(EstimatorSummary, EveryFigureThatThePageNamesIsDrawnFromTheFirstTwentyRuns) {
  const auto drawn = figures(spec_of_linear_cell(), rows_with(alternating()));
  ASSERT_TRUE(drawn);
  ASSERT_EQ(drawn->size(), 2U);
  EXPECT_EQ((*drawn)[0].id, "Fig. 3-10");
  EXPECT_EQ((*drawn)[1].id, "Fig. 3-11");
  const auto& dots = std::get<plot::Points>((*drawn)[0].figure.panels.at(0).marks.at(0));
  EXPECT_EQ(dots.y.size(), 2U * 20U);
  EXPECT_NEAR(dots.y.front(), 1.0, 1e-9);
}

TEST(EstimatorSummary, NoRunsMakeNoRows) {
  const auto rows = tables(spec_of_linear_cell(), rows_with({}, 3));
  ASSERT_TRUE(rows);
  EXPECT_TRUE(rows->empty());
}

TEST(MeanError, IntervalsAreStudents) {
  const std::vector<double> values = {1.0, 2.0, 3.0, 4.0};
  const std::vector<std::size_t> picks = {0, 1, 2, 3};
  const ErrorOfRun error = [&](std::size_t run) { return values[run]; };
  const double s = std::sqrt(5.0 / 3.0);
  EXPECT_NEAR(range_of_mean(picks, error, 4), 2.353363435 * s / 2.0, 1e-8);
  EXPECT_FALSE(interval_holds_zero(picks, error));
  EXPECT_TRUE(interval_holds_zero(picks, [&](std::size_t run) { return values[run] - 2.5; }));
  EXPECT_TRUE(std::isnan(range_of_mean(std::vector<std::size_t>{0}, error, 4)));
}

}  // namespace
}  // namespace fatmc::estimators
