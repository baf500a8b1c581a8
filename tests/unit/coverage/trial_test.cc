#include "campaigns/coverage/trial.h"

#include <gtest/gtest.h>

#include "campaigns/base/prepared_trials.h"
#include "campaigns/coverage/row_arrays.h"
#include "campaigns/coverage/summary.h"
#include "coordinator/input/toml_file.h"

namespace fatmc::coverage {
namespace {

CampaignSpec shipped_spec() { return *decode_campaign(*read_toml_resolved("campaigns/coverage/spec.toml")); }

// The value at a dotted path of the spec, to be overwritten.
Tree& at(Tree& tree, std::initializer_list<std::string_view> path) {
  Tree* here = &tree;
  for (const std::string_view key : path) here = const_cast<Tree*>(here->find(key));
  return *here;
}

TEST(CoverageTrial, DependsOnItsRepetitionAlone) {
  const CampaignSpec spec = shipped_spec();
  const auto first = prepare_trials(kTrialStudy, spec, 0);
  const auto second = prepare_trials(kTrialStudy, spec, 0);
  ASSERT_TRUE(first && second);
  const TrialRow before = (*first)->run(3);
  (*second)->run(7);
  EXPECT_EQ(before, (*second)->run(3));
  EXPECT_NE(content_hash(before), content_hash((*second)->run(4)));
}

TEST(CoverageTrial, HoldsAllLinesAndElements) {
  const CampaignSpec spec = shipped_spec();
  const TrialRow row = (*prepare_trials(kTrialStudy, spec, 0))->run(0);
  EXPECT_EQ(row.outcome, "ok");
  for (const auto name : {kErrorReal, kErrorImag, kVariance, kBias, kBiasPrinted}) {
    ASSERT_NE(row.array(name), nullptr);
    EXPECT_EQ(row.array(name)->size(), 73U * 9U) << name;
  }
  EXPECT_EQ(row.array(kInputSnr)->size(), 73U * 3U);
}

TEST(CoverageTrial, AFlightThatLeavesTheModelIsAnOutcomeOfItsRow) {
  CampaignSpec spec = shipped_spec();
  at(spec.tree, {"experiment", "excitation"})
      .set("amplitude_rad_s",
           Tree{Tree::Array{{Tree{2.0, {}, 0}, Tree{2.0, {}, 0}, Tree{2.0, {}, 0}}}, {}, 0});
  const auto cell = prepare_trials(kTrialStudy, spec, 0);
  ASSERT_TRUE(cell) << cell.error().text();
  const TrialRow row = (*cell)->run(0);
  EXPECT_EQ(row.outcome, "diverged");
  EXPECT_NE(row.detail.find(" at "), std::string::npos);
  EXPECT_EQ(row.array(kErrorReal), nullptr);
  // The table of such trials alone is empty, not a table of zeros.
  const auto tables_of =
      tables(spec, [&](std::uint32_t, const std::function<void(const TrialRow&)>& visit) { visit(row); });
  ASSERT_TRUE(tables_of);
  EXPECT_TRUE(tables_of->empty());
}

TEST(CoverageTrial, AnErrorInTheSpecNamesFileLineAndKey) {
  CampaignSpec spec = shipped_spec();
  at(spec.tree, {"estimator", "n_e"}).value = std::int64_t{2};
  const auto cell = prepare_trials(kTrialStudy, spec, 0);
  ASSERT_FALSE(cell);
  EXPECT_EQ(cell.error().file, "campaigns/coverage/spec.toml");
  EXPECT_GT(cell.error().line, 0);
  EXPECT_FALSE(cell.error().message.empty());
}

}  // namespace
}  // namespace fatmc::coverage
