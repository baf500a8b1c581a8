// The coverage study with drawn parameters: each trial is that of its own airframe.
#include <gtest/gtest.h>

#include <cmath>

#include "campaigns/base/prepared_trials.h"
#include "campaigns/base/spec_path.h"
#include "campaigns/coverage/row_arrays.h"
#include "campaigns/coverage/trial.h"
#include "coordinator/input/toml_file.h"

namespace fatmc::coverage {
namespace {

CampaignSpec shipped_spec() {
  return *decode_campaign(*read_toml_resolved("campaigns/coverage/dispersed.toml"));
}

double metric(const TrialRow& row, std::string_view name) {
  for (const auto& [key, value] : row.metrics) {
    if (key == name) return value;
  }
  ADD_FAILURE() << "no metric " << name;
  return 0.0;
}

TEST(DispersedCoverage, ATrialIsThatOfASpecWithTheDrawnValuesWrittenIn) {
  const CampaignSpec spec = shipped_spec();
  const auto dispersed = prepare_trials(kTrialStudy, spec, 0);
  ASSERT_TRUE(dispersed) << dispersed.error().text();
  const TrialRow row = (*dispersed)->run(7);
  ASSERT_EQ(row.outcome, "ok");

  CampaignSpec written = spec;
  written.dispersions.clear();
  const auto set = [&](const char* path, double value) {
    ASSERT_TRUE(set_at(written.tree, path, Tree{value, "here", 1}));
  };
  const auto scale = [&](const char* path, double factor) {
    set(path, *real_value(*find_at(written.tree, path)) * factor);
  };
  set("model.mass.mass_kg", metric(row, "draw.mass"));
  set("model.trim.speed_m_s", metric(row, "draw.speed"));
  set("experiment.environment.turbulence_sigma_m_s", metric(row, "draw.turbulence"));
  scale("model.mass.ixx_kg_m2", metric(row, "draw.ixx"));
  scale("model.mass.iyy_kg_m2", metric(row, "draw.iyy"));
  scale("model.mass.izz_kg_m2", metric(row, "draw.izz"));
  scale("model.pitch.eta", metric(row, "draw.elevator"));
  scale("model.roll.xi", metric(row, "draw.aileron"));
  scale("experiment.controller.gain.3", metric(row, "draw.yaw_gain"));
  const auto plain = prepare_trials(kTrialStudy, written, 0);
  ASSERT_TRUE(plain) << plain.error().text();
  const TrialRow same = (*plain)->run(7);
  EXPECT_EQ(row.arrays, same.arrays);
  EXPECT_TRUE(std::equal(same.metrics.rbegin(), same.metrics.rend(), row.metrics.rbegin()));
  EXPECT_EQ(row.metrics.size(), same.metrics.size() + 9);
}

TEST(DispersedCoverage, TheNominalCellFliesTheModelOfTheFile) {
  const CampaignSpec spec = shipped_spec();
  const auto nominal = prepare_trials(kTrialStudy, spec, 1);
  ASSERT_TRUE(nominal);
  for (const auto& [name, value] : (*nominal)->run(0).metrics)
    EXPECT_FALSE(name.starts_with("draw.")) << name;
}

TEST(DispersedCoverage, TheRecordIsTheFlightBehindTheRow) {
  const CampaignSpec spec = shipped_spec();
  const auto cell = prepare_trials(kTrialStudy, spec, 0);
  ASSERT_TRUE(cell);
  const TrialRow row = (*cell)->run(3);
  const auto record = (*cell)->record(3);
  ASSERT_TRUE(record);
  EXPECT_EQ(record->names.at(12), "V");
  EXPECT_EQ(record->columns.rows(), 20000);
  EXPECT_NEAR(record->columns.col(12).mean(), metric(row, "mean_speed_m_s"), 1e-9);
  EXPECT_NEAR(std::sqrt(record->columns.col(4).squaredNorm() / 20000.0), metric(row, "input_rms_xi_c"),
              1e-12);
  EXPECT_NE(record->toml.find("period_samples = 10000"), std::string::npos);
}

TEST(DispersedCoverage, SharesInsideAreThoseOfTheArrays) {
  const CampaignSpec spec = shipped_spec();
  const TrialRow row = (*prepare_trials(kTrialStudy, spec, 1))->run(0);
  // F^-1(0.95; 2, 20) = 10 (0.05^(-1/10) - 1), T (2.207) with q = 10.
  const double quantile = 10.0 * (std::pow(0.05, -0.1) - 1.0);
  const auto &re = *row.array(kErrorReal), &im = *row.array(kErrorImag), &variance = *row.array(kVariance),
             &bias = *row.array(kBias);
  double inside = 0.0, extended = 0.0;
  for (std::size_t i = 0; i < re.size(); ++i) {
    const double error = std::hypot(re[i], im[i]), beyond = std::max(0.0, error - bias[i]);
    inside += error * error <= quantile * variance[i] ? 1.0 : 0.0;
    extended += beyond * beyond <= quantile * variance[i] ? 1.0 : 0.0;
  }
  EXPECT_DOUBLE_EQ(metric(row, kInside95), inside / static_cast<double>(re.size()));
  EXPECT_DOUBLE_EQ(metric(row, kInsideExtended95), extended / static_cast<double>(re.size()));
}

}  // namespace
}  // namespace fatmc::coverage
