#include <gtest/gtest.h>

#include <cmath>

#include "campaigns/base/prepared_trials.h"
#include "campaigns/base/published_figures.h"
#include "campaigns/stability/judged_runs.h"
#include "campaigns/stability/summary.h"
#include "campaigns/stability/trial.h"
#include "tests/unit/studies/shipped.h"

namespace fatmc::stability {
namespace {

using test::find;
using test::shipped;

const std::vector<double> kLines = {0.30, 0.33, 0.335, 0.34, 0.36, 2.3, 2.89};

// A run that is the same at all lines and under all readings, until a test says otherwise.
TrialRow hand_made(std::uint64_t repetition, double value, double p) {
  TrialRow row;
  row.key = {0, repetition};
  const auto array = [&](const std::string& name, double x) {
    row.arrays.emplace_back(name, std::vector<double>(kLines.size(), x));
  };
  row.arrays.emplace_back(kFrequency, kLines);
  array(std::string(kNominalHInfinity), 0.2);
  array(std::string(kNominalSsv), 0.1);
  array(std::string(kSmallestSnr), 30.0);
  for (const Reading& reading : kReadings) {
    for (const Criterion criterion : {Criterion::h_infinity, Criterion::ssv}) {
      array(value_array(reading, criterion), value);
      for (const Rule rule : kRules) array(confidence_array(reading, criterion, rule), p);
    }
  }
  row.metrics.emplace_back(kMinimumSnr, 20.0);
  return row;
}

double& at(TrialRow& row, const std::string& name, std::size_t line) {
  for (auto& [key, values] : row.arrays) {
    if (key == name) return values.at(line);
  }
  throw std::runtime_error("no array " + name);
}

std::vector<TableRow> tables_of(const std::vector<TrialRow>& rows) {
  auto out = tables(shipped("stability"), test::source_of(rows));
  if (!out) throw std::runtime_error(out.error().text());
  return *out;
}

TEST(StabilitySummary, CountsRunsBeyondTheLimitAtTheWorstLine) {
  std::vector<TrialRow> rows;
  for (std::uint64_t run = 0; run < 10; ++run) rows.push_back(hand_made(run, 0.5, 0.99));
  for (std::size_t run = 0; run < 3; ++run) at(rows[run], "limit.hinf", 4) = 1.5;
  at(rows[9], "limit.hinf", 0) = 1.5;  // another line: the worst has three
  const auto out = tables_of(rows);
  const TableRow& row =
      find(out, "Fig. 5-6", "0.29-0.40 Hz", "largest share of all runs above 0 dB, b of (2.145)");
  EXPECT_DOUBLE_EQ(row.value, 30.0);
  EXPECT_DOUBLE_EQ(row.published, 25.0);
  EXPECT_EQ(row.verdict, "match");
  EXPECT_GE(row.low, 0.0);
  EXPECT_DOUBLE_EQ(
      find(out, "Fig. 5-6", "2.1-2.5 Hz", "largest share of all runs above 0 dB, b of (2.145)").value, 0.0);
  EXPECT_NEAR(
      find(out, "Section 5.4", "all lines", "nominal H-infinity above ssv, mean over the lines").value,
      20.0 * std::log10(2.0), 1e-12);
}

TEST(StabilitySummary, TakesQuantilesOverRunsAndExtremesOverLines) {
  std::vector<TrialRow> rows;
  for (std::uint64_t run = 0; run < 5; ++run) rows.push_back(hand_made(run, 0.5, 0.9));
  const std::vector<double> p = {0.1, 0.2, 0.3, 0.4, 0.5};
  for (std::size_t run = 0; run < 5; ++run) {
    at(rows[run], "limit.p_ssv", 5) = p[run];
    at(rows[run], "limit.p_hinf", 1) = 0.0;  // 0.33 Hz is left out of the quantile around
    at(rows[run], "limit.p_hinf", 0) = p[run] + 0.4;
  }
  const auto out = tables_of(rows);
  EXPECT_DOUBLE_EQ(find(out, "Fig. 5-9", "all lines", "smallest median of p, b of (2.145), min").value, 0.3);
  EXPECT_DOUBLE_EQ(find(out, "Fig. 5-9", "all lines", "smallest 25 % quantile of p, b of (2.145), min").value,
                   0.2);
  EXPECT_DOUBLE_EQ(
      find(out, "Fig. 5-8", "0.29-0.35 Hz", "smallest 25 % quantile of p, b of (2.145), min").value, 0.6);
  EXPECT_DOUBLE_EQ(find(out, "Fig. 5-8", "0.33 Hz", "share of all runs with p = 0, b of (2.145), min").value,
                   100.0);
  EXPECT_DOUBLE_EQ(find(out, "Fig. 5-8", "0.34 Hz", "share of all runs with p = 0, b of (2.145), min").value,
                   0.0);
}

TEST(StabilitySummary, MultipliesLinesIntoTheBandAndCountsFailedRunsAsNoConfidence) {
  std::vector<TrialRow> rows;
  for (std::uint64_t run = 0; run < 9; ++run) rows.push_back(hand_made(run, 0.5, 1.0));
  for (std::size_t line = 0; line < 2; ++line) at(rows[0], "limit.p_ssv", line) = 0.97;  // 0.9409
  at(rows[1], "limit.p_ssv", 3) = 0.0;
  TrialRow failed;
  failed.key = {0, 9};
  failed.outcome = "diverged";
  rows.push_back(failed);
  const auto out = tables_of(rows);
  EXPECT_DOUBLE_EQ(find(out, "Fig. 5-10", "p(B)", "share of all runs above 99 %, b of (2.145), min").value,
                   70.0);
  EXPECT_DOUBLE_EQ(find(out, "Fig. 5-10", "p(B)", "share of all runs above 90 %, b of (2.145), min").value,
                   80.0);
  const TableRow& zero = find(out, "Fig. 5-10", "p(B)", "share of all runs at zero, b of (2.145), min");
  EXPECT_DOUBLE_EQ(zero.value, 20.0);
  EXPECT_EQ(zero.n, 10U);
  EXPECT_NE(zero.why.find("1 trials without an estimate"), std::string::npos);
  // The same denominator everywhere, and nowhere on the side of stability.
  const auto share = [&](const char* table, const char* row, const std::string& quantity) {
    const TableRow& found = find(out, table, row, "share of all runs " + quantity);
    EXPECT_EQ(found.n, 10U) << quantity;
    return found.value;
  };
  EXPECT_DOUBLE_EQ(share("Section 5.4", "all lines", "with nominal ssv below 0 dB"), 90.0);
  EXPECT_DOUBLE_EQ(share("Section 5.6", "all lines", "with an input SNR below the limit at a line"), 10.0);
  EXPECT_DOUBLE_EQ(share("Fig. 5-8", "0.33 Hz", "with p = 0, b of (2.145), min"), 10.0);
  EXPECT_DOUBLE_EQ(share("Fig. 5-9", "all lines", "with p = 0 at a line, b of (2.145), min"), 20.0);
  EXPECT_DOUBLE_EQ(
      find(out, "Fig. 5-7", "all lines", "largest share of all runs above 0 dB, b of (2.145)").value, 10.0);
  for (const TableRow& row : out) EXPECT_FALSE(std::isnan(row.value)) << row.table << row.quantity;
}

TEST(StabilitySummary, TotalConfidenceNeedsNominalStabilityAndSnr) {
  std::vector<TrialRow> rows;
  for (std::uint64_t run = 0; run < 4; ++run) rows.push_back(hand_made(run, 0.5, 1.0));
  at(rows[0], std::string(kSmallestSnr), 2) = 19.9;
  at(rows[1], std::string(kNominalHInfinity), 2) = 1.1;  // ssv stays below 1
  const auto out = tables_of(rows);
  EXPECT_DOUBLE_EQ(
      find(out, "Section 5.6", "total p(B), ssv", "share of all runs at zero, b of (2.145), min").value,
      25.0);
  EXPECT_DOUBLE_EQ(
      find(out, "Section 5.6", "total p(B), H-infinity", "share of all runs at zero, b of (2.145), min")
          .value,
      50.0);
  EXPECT_DOUBLE_EQ(
      find(out, "Section 5.6", "all lines", "share of all runs with an input SNR below the limit at a line")
          .value,
      25.0);
  EXPECT_DOUBLE_EQ(
      find(out, "Section 5.4", "all lines", "share of all runs with nominal H-infinity below 0 dB").value,
      75.0);
}

TEST(StabilitySummary, HasARowForEveryPublishedFigureAndDrawsNineFigures) {
  std::vector<TrialRow> rows;
  for (std::uint64_t run = 0; run < 9; ++run)
    rows.push_back(hand_made(run, 0.3 + 0.06 * static_cast<double>(run), 0.8));
  const CampaignSpec spec = shipped("stability");
  EXPECT_EQ(test::complaints(tables_of(rows), decode_published(spec)->size()), "");
  const auto drawn = figures(spec, test::source_of(rows));
  ASSERT_TRUE(drawn);
  ASSERT_EQ(drawn->size(), 9U);
  EXPECT_EQ(drawn->front().id, "Fig. 5-5");
  for (const StudyFigure& figure : *drawn) EXPECT_NE(figure.figure.title, "") << figure.id;
  // The limit is drawn where values stay far below it.
  const auto& limit = std::get<plot::Line>(drawn->front().figure.panels.front().marks.back());
  EXPECT_EQ(limit.name, "limit of stability");
  EXPECT_EQ(limit.y, (std::vector<double>{0.0, 0.0}));
  EXPECT_EQ(drawn->back().id, "Fig. 5-13");
}

const std::vector<double>& array(const TrialRow& row, const std::string& name) { return array_of(row, name); }

TEST(StabilityTrial, WithoutBiasAndIntergridErrorGivesTheLevelOfKappa) {
  CampaignSpec spec = shipped("stability");
  test::set(spec, {"stability", "intergrid"}, Tree{0.0, {}, 0});
  const auto cell = prepare_trials(kTrialStudy, spec, 0);
  ASSERT_TRUE(cell) << cell.error().text();
  const TrialRow row = (*cell)->run(2);
  ASSERT_EQ(row.outcome, "ok");
  ASSERT_EQ(array(row, "off.hinf").size(), 73U);
  for (std::size_t k = 0; k < 73; ++k) {
    // (2.266) with 2M - 2 = 20: every element has the same level, so min is that of any.
    const double kappa = 1.0 / array(row, "off.hinf")[k];
    EXPECT_NEAR(array(row, "off.p_hinf")[k], 1.0 - std::pow(1.0 + kappa * kappa / 10.0, -10.0), 1e-12);
  }
}

TEST(StabilityTrial, KeepsTheOrderOfCriteriaAndRules) {
  const TrialRow row = (*prepare_trials(kTrialStudy, shipped("stability"), 0))->run(0);
  for (const Reading& reading : kReadings) {
    for (std::size_t k = 0; k < 73; ++k) {
      using enum Criterion;
      EXPECT_LE(array(row, value_array(reading, ssv))[k],
                array(row, value_array(reading, h_infinity))[k] * (1 + 1e-9));
      for (const Rule rule : kRules) {
        EXPECT_GE(array(row, confidence_array(reading, ssv, rule))[k] + 1e-12,
                  array(row, confidence_array(reading, h_infinity, rule))[k]);
      }
      EXPECT_LE(array(row, confidence_array(reading, ssv, Rule::bonferroni))[k],
                array(row, confidence_array(reading, ssv, Rule::min))[k] + 1e-12);
    }
  }
  double product = 1.0;
  for (const double p : array(row, "limit.p_ssv")) product *= p;
  EXPECT_NEAR(metric_of(row, kBandSsv), product, 1e-12);
}

TEST(StabilityTrial, RefusesANominalLoopThatIsNotStable) {
  CampaignSpec spec = shipped("stability");
  test::set(spec, {"experiment", "controller", "gain"},
            Tree{Tree::Array{{Tree{20.0, {}, 0}, Tree{20.0, {}, 0}, Tree{20.0, {}, 0}}}, {}, 0});
  const auto cell = prepare_trials(kTrialStudy, spec, 0);
  ASSERT_FALSE(cell);
  EXPECT_EQ(cell.error().key, "experiment.controller.gain");
  EXPECT_NE(cell.error().message.find("smaller gain"), std::string::npos);
}

}  // namespace
}  // namespace fatmc::stability
