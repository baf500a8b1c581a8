#include "campaigns/hidden_effect/bars.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "campaigns/base/verdict.h"
#include "campaigns/hidden_effect/row_metrics.h"
#include "campaigns/hidden_effect/summary.h"
#include "coordinator/input/toml_file.h"

namespace fatmc::hidden_effect {
namespace {

using testing::HasSubstr;

TableRow judged(double value, double low, double high, const Bar& bar) {
  TableRow row = table_row("t", "r", "q", "%");
  row.value = value;
  row.low = low;
  row.high = high;
  judge_by_bar(row, bar);
  return row;
}

TEST(HiddenEffectBars, AreMetByTheValueAndSayWhetherTheIntervalReachesThem) {
  const Bar right = bar_of(Role::single, Quantity::right), alarm = bar_of(Role::null, Quantity::false_alarm);
  EXPECT_EQ(judged(98.0, 97.5, 98.5, right).verdict, "match");
  EXPECT_EQ(judged(96.0, 95.0, 98.0, right).verdict, "differs")
      << "an interval that reaches the bar meets nothing";
  EXPECT_THAT(judged(96.0, 95.0, 98.0, right).why, HasSubstr("the interval holds it"));
  EXPECT_THAT(judged(90.0, 88.0, 92.0, right).why, Not(HasSubstr("interval")));
  EXPECT_EQ(judged(0.9, 0.5, 1.4, alarm).verdict, "match");
  EXPECT_EQ(judged(1.1, 0.7, 1.6, alarm).verdict, "differs");
  const Bar covered = bar_of(Role::quarter, Quantity::covered);
  EXPECT_EQ(judged(95.0, 94.0, 96.0, covered).verdict, "match");
  EXPECT_EQ(judged(99.0, 98.5, 99.4, covered).verdict, "differs") << "intervals may be too wide as well";
  EXPECT_EQ(judged(90.0, 88.0, 91.0, covered).verdict, "differs");
  EXPECT_EQ(judged(50.0, 40.0, 60.0, bar_of(Role::none, Quantity::right)).verdict, "");
}

TEST(HiddenEffectBars, AskForUnknownWhereNothingKnownIsHiddenAndAgainstItElsewhere) {
  EXPECT_EQ(bar_of(Role::unknown, Quantity::unknown).at_least, 95.0);
  EXPECT_EQ(bar_of(Role::unknown, Quantity::unknown_absorbable).at_least, 60.0);
  for (const Role role : {Role::single, Role::quarter, Role::two, Role::guard})
    EXPECT_EQ(bar_of(role, Quantity::unknown).at_most, 3.0);
}

/// The table of a campaign of one cell.
std::vector<TableRow> table_of(const std::string& cell, const std::vector<TrialRow>& rows) {
  CampaignSpec spec;
  Tree tree{Tree::Table{}, "spec", 1};
  tree.set("tier", Tree{cell, "spec", 1});
  tree.set("hide", Tree{std::int64_t{cell == "null" ? 0 : 1}, "spec", 1});
  tree.set("hidden", Tree{Tree::Array{{Tree{std::string("mass"), "spec", 1}}}, "spec", 1});
  spec.cells.push_back({"one", rows.size(), 0, true, tree});
  const auto out =
      kSummaryStudy.tables(spec, [&](std::uint32_t, const std::function<void(const TrialRow&)>& visit) {
        for (const TrialRow& row : rows) visit(row);
      });
  EXPECT_TRUE(out) << out.error().text();
  return *out;
}

const TableRow& find(const std::vector<TableRow>& rows, const std::string& quantity) {
  const auto at =
      std::find_if(rows.begin(), rows.end(), [&](const TableRow& r) { return r.quantity == quantity; });
  if (at != rows.end()) return *at;
  ADD_FAILURE() << "no row " << quantity;
  static const TableRow none;
  return none;
}

TrialRow trial(double verdict, double right, double hidden = 0.0) {
  TrialRow row;
  row.metrics = {{kHidden[0], hidden}, {kHidden[1], -1.0}, {kVerdict, verdict},  {kRight[0], right},
                 {kNamed[0], 3.0},     {kSpurious, 0.0},   {kClassHolds, right}, {kClassSize, 1.0}};
  return row;
}

TEST(HiddenEffectTables, CountTrialsWithoutAnAnswerInEveryDenominator) {
  TrialRow lost;
  lost.outcome = "diverged";
  lost.metrics = {{kHidden[0], 0.0}, {kHidden[1], -1.0}};
  const auto rows = table_of("single", {trial(1, 1), trial(1, 1), trial(3, 0), lost});
  EXPECT_EQ(find(rows, "no answer").value, 25.0);
  EXPECT_EQ(find(rows, "detected").value, 75.0);
  EXPECT_EQ(find(rows, "right name").value, 50.0);
  EXPECT_EQ(find(rows, "right name").n, 4u);
  EXPECT_EQ(find(rows, "known flagged as unknown").value, 25.0);
}

TEST(HiddenEffectTables, SayWhatWasAnsweredInsteadOfTheRightName) {
  const auto rows = table_of("single", {trial(1, 1), trial(1, 0), trial(0, 0), trial(3, 0)});
  const std::string hidden = effect_variants().front().name() + ": answered ";
  EXPECT_EQ(find(rows, hidden + effect_variants()[3].name()).value, 25.0);
  EXPECT_EQ(find(rows, hidden + "nothing").value, 25.0);
  EXPECT_EQ(find(rows, hidden + "unknown").value, 25.0);
  EXPECT_EQ(find(rows, "confident wrong name").value, 25.0);
}

TEST(HiddenEffectTables, GiveTheBoundOfTheFalseAlarmItsOwnBar) {
  std::vector<TrialRow> quiet(100, trial(0, 0, -1.0));
  const auto rows = table_of("null", quiet);
  EXPECT_EQ(find(rows, "false alarm").value, 0.0);
  EXPECT_EQ(find(rows, "false alarm").verdict, "match");
  const TableRow& bound = find(rows, "false alarm, one-sided upper 95 % bound");
  EXPECT_GT(bound.value, 1.5) << "100 trials without alarm do not show a rate below 1.5 %";
  EXPECT_EQ(bound.verdict, "differs");
}

}  // namespace
}  // namespace fatmc::hidden_effect
