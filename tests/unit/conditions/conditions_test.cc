// Trials and tables of the conditions study.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "campaigns/base/prepared_trials.h"
#include "campaigns/conditions/condition_runs.h"
#include "campaigns/conditions/row_arrays.h"
#include "campaigns/conditions/summary.h"
#include "campaigns/conditions/trial.h"
#include "coordinator/input/toml_file.h"

namespace fatmc::conditions {
namespace {

CampaignSpec shipped(const char* file = "campaigns/conditions/spec.toml") {
  return *decode_campaign(*read_toml_resolved(file));
}

Tree& at(Tree& tree, std::initializer_list<std::string_view> path) {
  Tree* here = &tree;
  for (const std::string_view key : path) here = const_cast<Tree*>(here->find(key));
  return *here;
}

TableRow find(const std::vector<TableRow>& rows, const std::string& row, const std::string& quantity) {
  for (const TableRow& r : rows) {
    if (r.row == row && r.quantity == quantity) return r;
  }
  throw std::runtime_error("no row " + row + ", " + quantity);
}

TEST(ConditionTrial, DependsOnItsRepetitionAlone) {
  const CampaignSpec spec = shipped();
  const auto first = prepare_trials(kTrialStudy, spec, 0), second = prepare_trials(kTrialStudy, spec, 0);
  ASSERT_TRUE(first && second);
  const TrialRow before = (*first)->run(3);
  (*second)->run(7);
  EXPECT_EQ(before, (*second)->run(3));
}

// Linear plant, calm air, exact gyros: what is left is the interpolation error. A quadratic through a window of h = 0.09 Hz
// at the border errs by c3 h^3/20 at its end (20: leading coefficient of the shifted Legendre polynomial P3), and
// c3 <= 1/(0.27 Hz)^3 relative, 0.27 Hz being the distance to the nearest pole or zero: 1.9e-3.
TEST(ConditionTrial, WithoutNoiseALinearPlantIsFoundUpToTheInterpolationError) {
  CampaignSpec spec = shipped("campaigns/conditions/turn_coordinator.toml");
  at(spec.tree, {"experiment", "environment", "turbulence_sigma_m_s"}).value = 0.0;
  at(spec.tree, {"experiment", "imu", "grade"}).value = std::string("none");
  at(spec.tree, {"experiment", "simulation", "plant"}).value = std::string("linear");
  at(spec.tree, {"estimator", "speed_correction"}).value = false;
  const Tree range{Tree::Array{{Tree{0.6, {}, 0}, Tree{0.9, {}, 0}, Tree{0.005, {}, 0}}}, {}, 0};
  at(spec.tree, {"experiment", "excitation"}).set("ranges_hz", Tree{Tree::Array{{range}}, {}, 0});
  const TrialRow row = (*prepare_trials(kTrialStudy, spec, 0))->run(0);
  ASSERT_EQ(row.outcome, "ok") << row.detail;
  for (const Element& element : kElements) {
    for (const auto& [name, value] : row.metrics) {
      if (name == name_of(element, kRelativeError)) {
        EXPECT_LT(value, 1.9e-3) << name;
      }
    }
  }
}

TEST(ConditionTrial, SevereGustsMayEndAFlightAndSayHow) {
  CampaignSpec spec = shipped();
  for (std::uint32_t i = 0; i < spec.cells.size(); ++i) {
    Tree& set = at(spec.cells[i].tree, {"set"});
    set.set("experiment.environment.turbulence_sigma_m_s", Tree{15.0, {}, 0});
  }
  const TrialRow row = (*prepare_trials(kTrialStudy, spec, 0))->run(0);
  EXPECT_EQ(row.outcome, "diverged");
  EXPECT_NE(row.detail.find(" at "), std::string::npos);
}

TrialRow row_of(std::uint32_t cell, std::uint64_t repetition, double error) {
  TrialRow row;
  row.key = {cell, repetition};
  row.arrays.emplace_back(kFrequency, std::vector<double>{1.0});
  for (const Element& element : kElements) {
    row.arrays.emplace_back(name_of(element, kErrorReal), std::vector<double>{error});
    row.arrays.emplace_back(name_of(element, kErrorImag), std::vector<double>{0.0});
    row.metrics.emplace_back(name_of(element, kRelativeError), std::abs(error));
  }
  row.metrics.emplace_back(kInside95, 1.0);
  for (const auto name : kMedianSnr) row.metrics.emplace_back(name, 20.0);
  row.metrics.emplace_back(kOutliers, 0.5);
  for (const char* servo : {"aileron", "left_ruddervator", "right_ruddervator"})
    row.metrics.emplace_back(std::string("share_at_rate_limit_") + servo, servo[0] == 'l' ? 0.25 : 0.0);
  return row;
}

RowSource rows_with(int lost) {
  return [=](std::uint32_t cell, const std::function<void(const TrialRow&)>& visit) {
    for (std::uint64_t k = 0; k < 4; ++k) visit(row_of(cell, k, k % 2 == 0 ? 0.01 : -0.03));
    for (int k = 0; k < lost; ++k) {
      TrialRow row;
      row.key = {cell, 4 + static_cast<std::uint64_t>(k)};
      row.outcome = "diverged";
      row.detail = "airspeed at 7 s";
      visit(row);
    }
  };
}

TEST(ConditionSummary, LostFlightsAreCountedInEveryShare) {
  const CampaignSpec spec = shipped();
  const auto rows = tables(spec, rows_with(4));
  ASSERT_TRUE(rows);
  const std::string& cell = spec.cells.front().name;
  const TableRow lost = find(*rows, cell, "flights that gave no estimate");
  EXPECT_NEAR(lost.value, 50.0, 1e-12);
  EXPECT_NE(lost.why.find("airspeed at 7 s"), std::string::npos);
  EXPECT_NEAR(find(*rows, cell, "share of 95 % regions that hold G0").value, 50.0, 1e-12);
  EXPECT_NEAR(find(*rows, cell, "rms of |error|/|G0|, q/η_c").value, 2.0, 1e-12);
  EXPECT_NEAR(find(*rows, cell, "share of lines and inputs below 3 standard deviations").value, 50.0, 1e-12);
  EXPECT_NEAR(find(*rows, cell, "time that a servo stands at its rate limit").value, 25.0, 1e-12);
}

TEST(ConditionSummary, ConditionsAreReadFromTheSpecOfTheirCell) {
  const auto cells = collect(shipped(), rows_with(0));
  ASSERT_TRUE(cells);
  ASSERT_EQ(cells->size(), 16U);
  EXPECT_EQ((*cells)[0].condition.turbulence_m_s, 0.5);
  EXPECT_EQ((*cells)[15].condition.turbulence_m_s, 4.4);
  EXPECT_EQ((*cells)[15].condition.grade, "industrial");
  EXPECT_EQ((*cells)[15].condition.gain, 0.5);
  // Mean and scatter of +1 %, -3 %, +1 %, -3 %.
  EXPECT_NEAR((*cells)[0].mean_error[1][0].real(), -0.01, 1e-15);
  EXPECT_NEAR((*cells)[0].deviation[1][0], 0.02 * std::sqrt(4.0 / 3.0), 1e-15);
}

TEST(ConditionSummary, FiguresFollowWhatTheCampaignVaries) {
  const auto conditions = figures(shipped(), rows_with(0));
  ASSERT_TRUE(conditions);
  ASSERT_EQ(conditions->size(), 1U);
  EXPECT_EQ((*conditions)[0].figure.panels.size(), 3U);
  const auto coordinator = figures(shipped("campaigns/conditions/turn_coordinator.toml"), rows_with(0));
  ASSERT_TRUE(coordinator);
  ASSERT_EQ(coordinator->size(), 1U);
  EXPECT_EQ((*coordinator)[0].id, "Section A.6");
  EXPECT_EQ((*coordinator)[0].figure.panels.size(), 2U);
}

}  // namespace
}  // namespace fatmc::conditions
