#include "campaigns/base/cell_grid.h"

#include "campaigns/base/campaign_spec.h"
#include "campaigns/base/spec_path.h"
#include "tests/unit/campaigns_base/toml_text.h"

namespace fatmc {
namespace {

const std::string kHead = "[campaign]\nstudy = \"s\"\nseed = 1\n[[cell]]\nname = \"c\"\nrepetitions = 5\n";

class CellGrid : public TomlTextTest {
 protected:
  std::string error_of(const std::string& text) {
    const auto spec = decode_campaign(read(text));
    return spec ? "no error" : spec.error().text().substr(path_.size() + 1);
  }
};

TEST_F(CellGrid, FactorsMakeEveryCombinationWithTheLastGoingFastest) {
  const auto spec = decode_campaign(
      read(kHead + "[[factor]]\npath = \"a.x\"\nvalues = [0.5, 1]\n"
                   "[[factor]]\npath = \"b\"\nname = \"kind\"\nvalues = [\"u\", true, [1, 2.5]]\n"));
  ASSERT_TRUE(spec) << spec.error().text();
  std::vector<std::string> names;
  for (const Cell& cell : spec->cells) names.push_back(cell.name);
  EXPECT_EQ(names,
            (std::vector<std::string>{"c, x=0.5, kind=u", "c, x=0.5, kind=true", "c, x=0.5, kind=[1 2.5]",
                                      "c, x=1, kind=u", "c, x=1, kind=true", "c, x=1, kind=[1 2.5]"}));
  EXPECT_EQ(spec->trial_count(), 30U);
  EXPECT_EQ(spec->tree.find("factor"), nullptr);
}

TEST_F(CellGrid, ANameAndItsSeedDoNotDependOnWhatElseAFactorHolds) {
  const auto few = decode_campaign(read(kHead + "[[factor]]\npath = \"a\"\nvalues = [2]\n"));
  const auto more = decode_campaign(read(kHead + "[[factor]]\npath = \"a\"\nvalues = [1, 2, 3]\n"));
  ASSERT_TRUE(few && more);
  EXPECT_EQ(few->trial_seed({0, 4}).cell, more->trial_seed({1, 4}).cell);
}

TEST_F(CellGrid, LabelsAndOwnCountsBelongToValuesAndTheLargestCountHolds) {
  const auto spec =
      decode_campaign(read(kHead + "[[factor]]\npath = \"a\"\nvalues = [1, 2]\nlabels = [\"low\", \"high\"]\n"
                                   "repetitions = [10, 20]\n[[factor]]\npath = \"b\"\nvalues = [1, 2]\n"
                                   "repetitions = [15, 1]\n"));
  ASSERT_TRUE(spec) << spec.error().text();
  std::vector<std::pair<std::string, std::uint64_t>> cells;
  for (const Cell& cell : spec->cells) cells.emplace_back(cell.name, cell.repetitions);
  EXPECT_EQ(
      cells,
      (std::vector<std::pair<std::string, std::uint64_t>>{
          {"c, a=low, b=1", 15}, {"c, a=low, b=2", 10}, {"c, a=high, b=1", 20}, {"c, a=high, b=2", 20}}));
}

TEST_F(CellGrid, LinkedPathsTakeAListAValue) {
  const auto spec = decode_campaign(read(kHead + "[[factor]]\npaths = [\"a\", \"b\"]\nname = \"case\"\n"
                                                 "values = [[1, 2], [3, 4]]\nlabels = [\"one\", \"two\"]\n"));
  ASSERT_TRUE(spec) << spec.error().text();
  const auto set = values_set_by(spec->cells.at(1).tree);
  ASSERT_EQ(set.size(), 2U);
  EXPECT_EQ(spec->cells[1].name, "c, case=two");
  EXPECT_EQ(set[1].first, "b");
  EXPECT_EQ(real_value(set[1].second), 4.0);
}

TEST_F(CellGrid, TheSameSpecWrittenOutIsTheSameCampaign) {
  const auto factors = decode_campaign(read(kHead + "[[factor]]\npath = \"a.x\"\nvalues = [1, 2]\n"));
  const auto written = decode_campaign(read(
      "[campaign]\nstudy = \"s\"\nseed = 1\n[[cell]]\nname = \"c, x=1\"\nrepetitions = 9\nset.\"a.x\" = 1\n"
      "[[cell]]\nname = \"c, x=2\"\nrepetitions = 5\npriority = 3\nset.\"a.x\" = 2\n"));
  ASSERT_TRUE(factors && written);
  EXPECT_EQ(factors->identity(), written->identity());
}

TEST_F(CellGrid, NestedTablesOfSetCountAsPaths) {
  const Tree cell = read("[set]\n\"a.b\" = 1\nc.d.e = 2\n");
  const auto set = values_set_by(cell);
  ASSERT_EQ(set.size(), 2U);
  EXPECT_EQ(set[0].first, "a.b");
  EXPECT_EQ(set[1].first, "c.d.e");
}

TEST_F(CellGrid, ErrorsNameLineKeyAndRemedy) {
  EXPECT_EQ(error_of(kHead + "[[factor]]\npath = \"a\"\nvalues = []\n"),
            "9: factor.values: is no list of values, write [value, value, ...]");
  EXPECT_EQ(error_of(kHead + "[[factor]]\npath = \"a..b\"\nvalues = [1]\n"),
            "8: factor.path: \"a..b\" is no path, write one such as estimator.n_e");
  EXPECT_EQ(error_of(kHead + "[[factor]]\npath = \"campaign.seed\"\nvalues = [1]\n"),
            "8: factor.path: \"campaign.seed\" is not for a cell to set");
  EXPECT_EQ(error_of(kHead + "[[factor]]\npath = \"a\"\nvalues = [1]\nlabels = [\"x\", \"y\"]\n"),
            "10: factor.labels: is not of the size of values, write a label a value");
  EXPECT_EQ(
      error_of(kHead + "[[factor]]\npath = \"a\"\nvalues = [1]\n[[factor]]\npath = \"a\"\nvalues = [2]\n"),
      "12: factor.path: \"a\" is set by the cell or another factor, too; keep one of them");
  EXPECT_EQ(error_of(kHead + "[[factor]]\npath = \"a\"\nvalues = [1, 1]\n"),
            "5: cell.name: \"c, a=1\" names two cells, write another name");
  EXPECT_EQ(error_of(kHead + "[[factor]]\npath = \"a\"\nvalues = [1]\nvalue = 3\n").substr(0, 41),
            "10: factor.value: is not a known key, the");
}

class SpecPath : public TomlTextTest {};

TEST_F(SpecPath, ReachesTablesAndElementsOfListsCountedFromOne) {
  Tree tree = read("[a]\nx = 1\ny = [1, [2, 3]]\n");
  EXPECT_EQ(real_value(*find_at(tree, "a.y.2.1")), 2.0);
  EXPECT_EQ(find_at(tree, "a.y.3"), nullptr);
  EXPECT_EQ(find_at(tree, "a.x.z"), nullptr);
  const Tree value{7.5, "other.toml", 3};
  ASSERT_TRUE(set_at(tree, "a.y.2.2", value));
  ASSERT_TRUE(set_at(tree, "a.new.deep", value));
  EXPECT_EQ(*find_at(tree, "a.y.2.2"), value);
  EXPECT_EQ(*find_at(tree, "a.new.deep"), value);
}

TEST_F(SpecPath, AnErrorStandsAtTheValueAndNamesThePart) {
  Tree tree = read("[a]\nx = 1\ny = [1, 2]\n");
  const Tree value{7.5, "other.toml", 3};
  EXPECT_EQ(set_at(tree, "a.x.z", value).error().text(),
            "other.toml:3: a.x.z: \"a.x\" is an integer and has no entry \"z\"");
  EXPECT_EQ(set_at(tree, "a.y.0", value).error().text(),
            "other.toml:3: a.y.0: \"a.y.0\" names no element, write a number from 1 to 2");
}

}  // namespace
}  // namespace fatmc
