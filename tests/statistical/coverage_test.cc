// The law of the confidence regions where theory says that it holds: linear FAT, gusts, uniform grid of 0.005
// Hz from 0.285 to 2.89 Hz, 500 runs. Bar: 0.5 points at each level. Table 5-1's coarse windows are reported
// by the campaign campaigns/coverage/theory.toml, not tested here: nothing exact is known of them.
#include <gtest/gtest.h>

#include <vector>

#include "campaigns/coverage/summary.h"
#include "campaigns/coverage/trial.h"
#include "coordinator/input/toml_file.h"

namespace fatmc {
namespace {

TEST(Coverage, OnAUniformGridTheErrorAgainstTheSampleMeanHoldsItsLevels) {
  const auto tree = read_toml_resolved("campaigns/coverage/theory.toml");
  ASSERT_TRUE(tree) << tree.error().text();
  auto spec = decode_campaign(*tree);
  ASSERT_TRUE(spec);
  ASSERT_EQ(spec->cells.front().name, "linear, uniform grid");
  ASSERT_EQ(spec->cells.front().repetitions, 500U);
  spec->cells.resize(1);
  const auto cell = coverage::kTrialStudy.prepare(*spec, 0);
  ASSERT_TRUE(cell) << cell.error().text();
  std::vector<TrialRow> rows;
  for (std::uint64_t repetition = 0; repetition < 500; ++repetition) rows.push_back((*cell)->run(repetition));
  const auto tables =
      coverage::tables(*spec, [&](std::uint32_t, const std::function<void(const TrialRow&)>& visit) {
        for (const TrialRow& row : rows) visit(row);
      });
  ASSERT_TRUE(tables);
  int checked = 0;
  for (const TableRow& row : *tables) {
    if (row.table != "5-5" || row.quantity != "error against the sample mean") continue;
    EXPECT_NEAR(row.value, std::stod(row.row), 0.5) << row.row;
    ++checked;
  }
  EXPECT_EQ(checked, 4);
}

}  // namespace
}  // namespace fatmc
