#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "campaigns/base/prepared_trials.h"
#include "campaigns/base/published_figures.h"
#include "campaigns/bias/error_runs.h"
#include "campaigns/bias/summary.h"
#include "campaigns/bias/trial.h"
#include "tests/unit/studies/shipped.h"

namespace fatmc::bias {
namespace {

using test::find;
using test::shipped;

const std::vector<double> kLines = {0.05, 0.08, 0.33, 0.48, 1.0};

std::complex<double> ratio_of(double decibel, double degrees) {
  return std::polar(std::pow(10.0, decibel / 20.0), degrees * std::numbers::pi / 180.0);
}

// `errors`: of every line, dB and degrees; the same for both responses but for the sign.
TrialRow hand_made(std::uint64_t repetition, const std::vector<std::complex<double>>& pitch,
                   const std::vector<std::complex<double>>& yaw, double relative) {
  TrialRow row;
  row.key = {0, repetition};
  row.arrays.emplace_back(kFrequency, kLines);
  for (std::size_t r = 0; r < kResponses.size(); ++r) {
    std::vector<double> re, im;
    for (const auto& value : r == 0 ? pitch : yaw) {
      re.push_back(value.real());
      im.push_back(value.imag());
    }
    row.arrays.emplace_back(ratio_re(kResponses[r]), re);
    row.arrays.emplace_back(ratio_im(kResponses[r]), im);
    for (const Reading& reading : kReadings)
      row.metrics.emplace_back(relative_bias(kResponses[r], reading), relative);
  }
  return row;
}

TEST(BiasSummary, AveragesTheEstimatesBeforeItTakesDecibels) {
  const std::vector<std::complex<double>> one(kLines.size(), 1.0);
  std::vector<std::complex<double>> first = one, second = one;
  first[1] = ratio_of(-6.0, 40.0);
  second[1] = ratio_of(-6.0, -40.0);
  const std::vector<TrialRow> rows = {hand_made(0, first, one, 1.0), hand_made(1, second, one, 1.0)};
  const auto out = tables(shipped("bias"), test::source_of(rows));
  ASSERT_TRUE(out);
  EXPECT_NEAR(find(*out, "4-2", "phugoid", "magnitude error").value,
              -6.0 + 20.0 * std::log10(std::cos(40.0 * std::numbers::pi / 180.0)), 1e-9);
  EXPECT_NEAR(find(*out, "4-2", "phugoid", "phase error").value, 0.0, 1e-9);
}

TEST(BiasSummary, GivesErrorsMeansRangesAndAmplificationOfKnownRatios) {
  const std::vector<std::complex<double>> pitch = {ratio_of(4.5, 54.1), ratio_of(-11.2, 4.85), 1.0,
                                                   ratio_of(-0.32, -2.5), 1.0};
  const std::vector<std::complex<double>> yaw = {ratio_of(7.8, 71.1), 1.0, ratio_of(-0.74, -10.1), 1.0, 1.0};
  std::vector<TrialRow> rows;
  for (std::uint64_t run = 0; run < 8; ++run) rows.push_back(hand_made(run, pitch, yaw, 3.9));
  const CampaignSpec spec = shipped("bias");
  const auto out = tables(spec, test::source_of(rows));
  ASSERT_TRUE(out);
  EXPECT_NEAR(find(*out, "4-2", "short period", "magnitude error").value, -0.32, 1e-9);
  EXPECT_NEAR(find(*out, "4-2", "zero of r/zeta", "phase error").value, 71.1, 1e-9);
  EXPECT_NEAR(find(*out, "4-2", "Dutch roll", "phase error").value, -10.1, 1e-9);
  const double mean = (4.5 - 11.2 - 0.32) / 5.0;
  EXPECT_NEAR(find(*out, "4-3", "pitch response", "mean magnitude error").value, mean, 1e-9);
  EXPECT_NEAR(find(*out, "4-4", "pitch response", "lower magnitude error").value, -11.2, 1e-9);
  EXPECT_NEAR(find(*out, "4-4", "yaw response", "lower phase error").value, -10.1, 1e-9);
  EXPECT_NEAR(find(*out, "4-5", "phugoid", "observed amplification").value,
              20.0 * std::log10(11.2 / std::abs(mean)), 1e-9);
  EXPECT_NEAR(find(*out, "Section 4.2.3", "phugoid", "bias estimate, b of (2.145)").value,
              20.0 * std::log10(4.9), 1e-9);
  EXPECT_EQ(
      find(*out, "4-5", "zero of r/zeta", "estimated amplification, (4.1) with 0.0857 and border factor 8")
          .verdict,
      "exact");
  EXPECT_EQ(test::complaints(*out, decode_published(spec)->size()), "");
}

// A linear plant in calm air leaves interpolation alone, and that dies out where the response is smooth.
TEST(BiasTrial, IsSmallWhereTheResponseIsSmoothAndLargeAtThePhugoid) {
  CampaignSpec spec = shipped("bias");
  test::set(spec, {"experiment", "simulation", "plant"}, Tree{std::string("linear"), {}, 0});
  const auto cell = prepare_trials(kTrialStudy, spec, 0);
  ASSERT_TRUE(cell) << cell.error().text();
  const TrialRow row = (*cell)->run(0);
  ASSERT_EQ(row.outcome, "ok");
  const std::vector<TrialRow> rows = {row};
  const ErrorRuns runs = error_runs(0, test::source_of(rows));
  ASSERT_EQ(runs.frequency_hz.size(), 496U);
  const std::size_t only = 0;
  for (std::size_t r = 0; r < kResponses.size(); ++r) {
    for (const double smooth_hz : {1.5, 3.0, 4.5})
      EXPECT_LT(std::abs(mean_ratio(runs, r, runs.nearest_line(smooth_hz), {&only, 1}) - 1.0), 2e-3)
          << smooth_hz;
  }
  EXPECT_GT(std::abs(mean_ratio(runs, 0, runs.nearest_line(0.08), {&only, 1}) - 1.0), 0.2);
  EXPECT_EQ(row, (*cell)->run(0));
}

TEST(BiasFigures, ShowTheResponseOfTheModelThatFlew) {
  const std::vector<std::complex<double>> one(496, 1.0);
  TrialRow row = hand_made(0, one, one, 1.0);
  for (auto& [name, values] : row.arrays) {
    if (name != kFrequency) continue;
    values.clear();
    for (int k = 5; k <= 500; ++k) values.push_back(0.01 * k);
  }
  const std::vector<TrialRow> rows = {row};
  const auto drawn = figures(shipped("bias"), test::source_of(rows));
  ASSERT_TRUE(drawn) << drawn.error().text();
  ASSERT_EQ(drawn->size(), 2U);
  const auto& estimate = std::get<plot::Line>(drawn->front().figure.panels.front().marks.front());
  const auto& nominal = std::get<plot::Line>(drawn->front().figure.panels.front().marks.at(1));
  EXPECT_EQ(estimate.y, nominal.y);  // no error: the same curve
}

}  // namespace
}  // namespace fatmc::bias
