// Drawn changes and a short monitored flight.
#include <gtest/gtest.h>

#include <cmath>

#include "campaigns/base/campaign_spec.h"
#include "campaigns/dynamics_change/change_cell.h"
#include "campaigns/dynamics_change/row_arrays.h"
#include "campaigns/dynamics_change/trial.h"
#include "coordinator/input/toml_file.h"

namespace fatmc::dynamics_change {
namespace {

CampaignSpec spec() {
  const Result<Tree> tree = read_toml_resolved("campaigns/dynamics_change/spec.toml");
  EXPECT_TRUE(tree.has_value()) << tree.error().text();
  Result<CampaignSpec> out = decode_campaign(*tree);
  EXPECT_TRUE(out.has_value()) << out.error().text();
  return *out;
}

std::uint32_t cell_named(const CampaignSpec& of, std::string_view name) {
  for (std::uint32_t i = 0; i < of.cells.size(); ++i) {
    if (of.cells[i].name == name) return i;
  }
  ADD_FAILURE() << name;
  return 0;
}

TEST(DrawnChange, LiesWhereTheCellSaysAndIsTheSameForAllAxes) {
  const CampaignSpec of = spec();
  const Result<ChangeCell> cell = decode_change_cell(of, cell_named(of, "sudden"));
  ASSERT_TRUE(cell.has_value()) << cell.error().text();
  int mirrored = 0;
  for (std::uint64_t n = 0; n < 200; ++n) {
    const std::vector<Effect> change = drawn_change(*cell, TrialSeed{1, 2, 3, n});
    ASSERT_EQ(change.size(), 3u);
    const double factor = change[0].values[0];
    const double smaller = factor > 1.0 ? 1.0 / factor : factor;
    mirrored += factor > 1.0;
    EXPECT_TRUE(smaller >= 0.4 && smaller <= 0.8) << factor;
    for (const Effect& effect : change) {
      EXPECT_EQ(effect.values[0], factor);
      EXPECT_EQ(effect.onset->start_s, change[0].onset->start_s);
      EXPECT_TRUE(effect.onset->start_s >= 500.0 && effect.onset->start_s <= 700.0);
      EXPECT_TRUE(check(effect).has_value());
    }
  }
  EXPECT_NEAR(mirrored, 100, 3 * std::sqrt(50.0));
}

TEST(DrawnChange, WhatIsWrongInACellIsSaidWithItsKey) {
  const auto error = [](std::string_view key, Tree value) {
    CampaignSpec of = spec();
    const std::uint32_t index = cell_named(of, "sudden");
    of.cells[index].tree.set(key, std::move(value));
    const Result<ChangeCell> cell = decode_change_cell(of, index);
    return cell ? std::string() : cell.error().text();
  };
  const auto number = [](double v) { return Tree{v, "spec.toml", 1}; };
  const auto list = [&](std::initializer_list<double> values) {
    Tree::Array array;
    for (const double v : values) array.items.push_back(number(v));
    return Tree{array, "spec.toml", 1};
  };
  EXPECT_NE(error("strength", list({0.01, 0.5})).find("strength"), std::string::npos);
  EXPECT_NE(error("strength", list({0.6, 0.5})).find("strength"), std::string::npos);
  EXPECT_NE(error("flight_s", number(1234.0)).find("flight_s"), std::string::npos);
  EXPECT_NE(error("flight_s", number(200.0)).find("flight_s"), std::string::npos);
  Tree::Array unknown;
  unknown.items.push_back(Tree{std::string("nonsense:x=1"), "spec.toml", 1});
  EXPECT_NE(error("change", Tree{unknown, "spec.toml", 1}).find("nonsense"), std::string::npos);
}

TEST(ChangeTrial, IsAPureFunctionAndSeesASuddenChangeInTheNoise) {
  const CampaignSpec of = spec();
  const auto cell = kTrialStudy.prepare(of, cell_named(of, "fivefold"));
  ASSERT_TRUE(cell.has_value()) << cell.error().text();
  const TrialRow row = (*cell)->run(3);
  EXPECT_EQ(row.outcome, "ok") << row.detail;
  EXPECT_EQ(content_hash(row), content_hash((*cell)->run(3)));
  const std::vector<double>& noise = *row.array(kNoise[0]);
  ASSERT_EQ(noise.size(), 140u);
  // Change at 600 s: epoch 59 ends there; 100 s later the window is a quarter new.
  EXPECT_LT(std::abs(noise[59] - noise[49]), 0.7);
  EXPECT_GT(noise[69] - noise[59], 2.0);
}

}  // namespace
}  // namespace fatmc::dynamics_change
