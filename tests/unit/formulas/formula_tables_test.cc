#include "campaigns/formulas/formula_tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace fatmc {
namespace {

TableRow find(const std::string& table, const std::string& row, const std::string& quantity) {
  const std::vector<TableRow> rows = formula_tables();
  const auto at = std::find_if(rows.begin(), rows.end(), [&](const TableRow& r) {
    return r.table == table && r.row == row && r.quantity.starts_with(quantity);
  });
  if (at == rows.end()) throw std::runtime_error("no row " + table + " " + row + " " + quantity);
  return *at;
}

TEST(FormulaTables, ReproduceEveryBiasOfTable21) {
  for (const TableRow& row : formula_tables()) {
    const bool literal =
        row.quantity.ends_with("as printed (2.41)") || row.quantity.ends_with("at the printed SNR");
    if (row.table != "2-1") continue;
    EXPECT_EQ(row.verdict, literal ? "differs" : "exact")
        << row.row << ", " << row.quantity << ": " << row.value;
  }
  EXPECT_NEAR(find("2-1", "SNR 3.1", "bias, uncorrelated (2.40)").value, std::exp(-10.0), 1e-18);
  EXPECT_EQ(find("2-1", "SNR 1", "bias, correlation -1, as printed").verdict, "differs");
}

TEST(FormulaTables, NameTheErrorsOfTables23And24) {
  EXPECT_EQ(find("2-3", "R = 2", "alpha, complex").verdict, "exact");
  EXPECT_EQ(find("2-3", "R = 4", "alpha, complex").verdict, "differs");
  EXPECT_EQ(find("2-3", "R = 4", "alpha 0.02^2").verdict, "exact");
  EXPECT_EQ(find("2-3", "R = 6", "alpha, complex").verdict, "differs");
  EXPECT_NEAR(find("2-4", "R = 2", "alpha, fit to the magnitude").value, 3.0 / 35.0 * 3.0 / 8.0, 1e-16);
  EXPECT_NEAR(find("2-4", "R = 6", "alpha, fit to the magnitude").value, 35.0 / 6435.0 * 35.0 / 128.0, 1e-17);
}

TEST(FormulaTables, OneWidthOfWindowGivesAllThreeFiguresOfTable24) {
  for (const char* order : {"R = 2", "R = 4", "R = 6"})
    EXPECT_EQ(find("2-4", order, "alpha, fit to the magnitude, window of 0.12").verdict, "exact") << order;
}

TEST(FormulaTables, ReproduceTheNumbersOfFigures217And235) {
  EXPECT_EQ(find("Fig. 2-17", "R = 2, 7 lines over 0.8 B_3dB", "peak of a fit").verdict, "exact");
  EXPECT_EQ(find("Fig. 2-17", "R = 2, 7 lines over 0.8 B_3dB", "the same in dB").verdict, "exact");
  EXPECT_EQ(find("Fig. 2-35", "df/f0 = 0.005, error 5 %", "damping").verdict, "exact");
}

TEST(FormulaTables, ReproduceTable31ByItsOwnRule) {
  EXPECT_NEAR(find("3-1", "phugoid", "T = 3").value, 746.0, 0.5);
  EXPECT_EQ(find("3-1", "phugoid", "T = 3").verdict, "exact");
  EXPECT_EQ(find("3-1", "actuators", "T = 3").verdict, "exact");
  const TableRow dutch_roll = find("3-1", "Dutch roll", "T = 3");
  EXPECT_EQ(dutch_roll.verdict, "shape");
  EXPECT_LT(dutch_roll.low, 78.3);
  EXPECT_GT(dutch_roll.high, 78.3);
  EXPECT_NEAR(find("3-1", "phugoid", "T = 7").value, 554.0, 0.5);
}

TEST(FormulaTables, CountTheLinesAndDegreesOfFreedomOfTheDesigns) {
  EXPECT_EQ(find("5-2", "degrees of freedom", "(2.147), m = 1, n_in,add = 1").verdict, "exact");
  EXPECT_EQ(find("4-1", "n_E", "(2.127), m = 2, n_in,add = 1").verdict, "exact");
  EXPECT_EQ(find("4-1", "degrees of freedom", "(2.147), m = 2, n_in,add = 1").value, 12.0);
  EXPECT_EQ(find("5-1", "excited lines", "last step 0.07").verdict, "exact");
  EXPECT_EQ(find("5-1", "excited lines", "last step 0.7 Hz").value, 43.0);
}

TEST(FormulaTables, GiveEveryRowAVerdictAndEveryDifferenceAReason) {
  for (const TableRow& row : formula_tables()) {
    if (std::isnan(row.published)) continue;  // a variant of what is not printed
    EXPECT_TRUE(row.verdict == "exact" || row.verdict == "shape" || row.verdict == "differs");
    EXPECT_TRUE(row.verdict == "exact" || !row.why.empty())
        << row.table << ", " << row.row << ", " << row.quantity;
  }
}

}  // namespace
}  // namespace fatmc
