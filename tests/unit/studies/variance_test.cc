#include <gtest/gtest.h>

#include <cmath>

#include "campaigns/base/prepared_trials.h"
#include "campaigns/base/published_figures.h"
#include "campaigns/variance/element_runs.h"
#include "campaigns/variance/summary.h"
#include "campaigns/variance/trial.h"
#include "tests/unit/studies/shipped.h"

namespace fatmc::variance {
namespace {

using test::find;
using test::shipped;

const std::vector<double> kLines = {0.05, 0.15, 1.0, 4.9, 5.0};

TEST(ShownLines, AreAllAtTheEndsAndEveryTenthBetween) {
  std::vector<double> hz;
  for (int k = 5; k <= 500; ++k) hz.push_back(0.01 * k);
  const std::vector<int> shown = shown_lines(hz);
  EXPECT_EQ(shown.size(), 16U + 46U + 16U);
  EXPECT_DOUBLE_EQ(hz[static_cast<std::size_t>(shown[15])], 0.20);
  EXPECT_NEAR(hz[static_cast<std::size_t>(shown[16])], 0.30, 1e-12);
  EXPECT_NEAR(hz[static_cast<std::size_t>(shown[17])], 0.40, 1e-12);
  EXPECT_EQ(shown.back(), 495);
}

// Estimates 3 +- d - j in turn: the variance between eight runs is 8/7 d^2.
TrialRow hand_made(std::uint64_t repetition, const std::vector<double>& d,
                   const std::vector<double>& variance) {
  TrialRow row;
  row.key = {0, repetition};
  row.arrays.emplace_back(kFrequency, kLines);
  std::vector<double> re, im, v;
  for (std::size_t k = 0; k < kLines.size(); ++k) {
    for (int e = 0; e < kElements; ++e) {
      re.push_back(3.0 + (repetition % 2 == 0 ? d[k] : -d[k]));
      im.push_back(-1.0);
      v.push_back(variance[k]);
    }
  }
  row.arrays.emplace_back(kReal, re);
  row.arrays.emplace_back(kImag, im);
  row.arrays.emplace_back(kVariance, v);
  return row;
}

TEST(VarianceSummary, ComparesTheEdgeWithTheEleventhLine) {
  const std::vector<double> d = {std::sqrt(7.2), 1.0, 1.0, 1.0, std::sqrt(3.3)};
  std::vector<double> variance = {7.2, 1.0, 2.0, 1.0, 3.3};
  for (double& v : variance) v *= 8.0 / 7.0;
  std::vector<TrialRow> rows;
  for (std::uint64_t run = 0; run < 8; ++run) rows.push_back(hand_made(run, d, variance));
  const CampaignSpec spec = shipped("variance");
  const auto out = tables(spec, test::source_of(rows));
  ASSERT_TRUE(out);
  EXPECT_NEAR(find(*out, "Section 4.3.3", "low border", "border factor, between runs").value, 7.2, 1e-9);
  EXPECT_NEAR(find(*out, "Section 4.3.3", "high border", "border factor, between runs").value, 3.3, 1e-9);
  EXPECT_NEAR(find(*out, "Section 4.3.3", "high border", "border factor, medians of the estimates").value,
              3.3, 1e-9);
  // 0 dB at four of the five lines, 3 dB at the one at 1 Hz, which stands for half of what lies between 0.15 and 4.9 Hz.
  const auto mean = [&](const char* lines) {
    return find(*out, "Section 4.3.2", lines, "median estimated over between runs, mean of dB").value;
  };
  EXPECT_NEAR(mean("lines of Fig. 4-3, all alike"), 2.0 * std::log10(2.0), 1e-9);
  EXPECT_NEAR(mean("lines of Fig. 4-3, by the band they stand for"),
              10.0 * std::log10(2.0) * 0.5 * (4.9 - 0.15) / (5.0 - 0.05), 1e-9);
  EXPECT_EQ(test::complaints(*out, decode_published(spec)->size()), "");
}

// The variance of a quadratic through N lines: 3 (3 N^2 - 3 N + 2)/(N (N + 1)(N + 2)) at its edge, 3 (3 N^2 - 7)/(4 N (N^2 - 4))
// in its middle.
TEST(VarianceSummary, KnowsTheBorderFactorOfWhiteNoiseForTheCellsOwnLines) {
  const std::vector<double> ones(kLines.size(), 1.0);
  const std::vector<TrialRow> rows = {hand_made(0, ones, ones), hand_made(1, ones, ones)};
  for (const int n_e : {10, 9}) {
    CampaignSpec spec = shipped("variance");
    test::set(spec, {"estimator", "n_e"}, Tree{static_cast<std::int64_t>(n_e), {}, 0});
    const auto out = tables(spec, test::source_of(rows));
    ASSERT_TRUE(out);
    const double n = 2.0 * n_e + 1.0;
    const double edge = 3.0 * (3.0 * n * n - 3.0 * n + 2.0) / (n * (n + 1.0) * (n + 2.0));
    const double middle = 3.0 * (3.0 * n * n - 7.0) / (4.0 * n * (n * n - 4.0));
    const TableRow& row = find(*out, "Section 4.3.3", "high border", "border factor, white noise, one input");
    EXPECT_NEAR(row.value, edge / middle, 1e-12);
    EXPECT_EQ(row.verdict, n_e == 10 ? "exact" : "shape");  // 3.31 and 3.24 beside 3.3
  }
}

TEST(VarianceTrial, KeepsTheShownLinesOfOneEstimate) {
  const auto cell = prepare_trials(kTrialStudy, shipped("variance"), 0);
  ASSERT_TRUE(cell) << cell.error().text();
  const TrialRow row = (*cell)->run(1);
  ASSERT_EQ(row.outcome, "ok");
  EXPECT_EQ(array_of(row, kFrequency).size(), 78U);
  for (const auto name : {kReal, kImag, kVariance}) EXPECT_EQ(array_of(row, name).size(), 78U * kElements);
  for (const double variance : array_of(row, kVariance)) EXPECT_GT(variance, 0.0);
  EXPECT_EQ(metric_of(row, "degrees_of_freedom"), 12.0);  // 2 * 10 + 1 - 9
  EXPECT_EQ(row, (*cell)->run(1));
}

TEST(VarianceFigures, DrawNinePanels) {
  const std::vector<double> ones(kLines.size(), 1.0);
  const std::vector<TrialRow> rows = {hand_made(0, ones, ones), hand_made(1, ones, ones)};
  const auto drawn = figures(shipped("variance"), test::source_of(rows));
  ASSERT_TRUE(drawn);
  ASSERT_EQ(drawn->size(), 1U);
  EXPECT_EQ(drawn->front().figure.panels.size(), 9U);
  const auto& between = std::get<plot::Line>(drawn->front().figure.panels.front().marks.back());
  EXPECT_NEAR(between.y.front(), 10.0 * std::log10(2.0), 1e-12);
}

}  // namespace
}  // namespace fatmc::variance
