// The views of docs/schema.md against the rows that were stored.
#include <SQLiteCpp/SQLiteCpp.h>

#include <bit>
#include <cstring>

#include "coordinator/store/schema.h"
#include "core/stats/confidence.h"
#include "tests/unit/store/example_rows.h"

namespace fatmc {
namespace {

class Views : public StoreFolder {
 protected:
  void store(std::vector<ComputedRow> rows) const {
    for (ComputedRow& row : rows) row.hash = content_hash(row.row);
    auto store = CampaignStore::open(path_, example_spec(), "build");
    ASSERT_TRUE(store) << store.error().text();
    store->commit(std::vector{request(std::move(rows))});
  }
  [[nodiscard]] std::vector<double> reals(const std::string& sql) const {
    SQLite::Database db(path_);
    SQLite::Statement query(db, sql);
    std::vector<double> out;
    while (query.executeStep()) {
      for (int i = 0; i < query.getColumnCount(); ++i) out.push_back(query.getColumn(i).getDouble());
    }
    return out;
  }
};

TEST_F(Views, AllOfThemAnswerOnAFileWithAndWithoutRows) {
  store({});
  for (const ViewDescription& view : kViews)
    EXPECT_NO_THROW((void)reals("SELECT * FROM " + std::string(view.name))) << view.name;
  store({example_row(0, 1, 2.0)});
  for (const ViewDescription& view : kViews)
    EXPECT_NO_THROW((void)reals("SELECT * FROM " + std::string(view.name))) << view.name;
}

TEST_F(Views, ElementsAreTheVeryDoublesThatWereStored) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<double> values = {0.0,
                                -0.0,
                                1.0,
                                -1.5,
                                0.1,
                                5e-324,
                                -1.1e-310,
                                2.2250738585072014e-308,
                                1.7976931348623157e308,
                                kInfinity,
                                -kInfinity,
                                1e300,
                                -1e-300,
                                M_PI};
  ComputedRow row = example_row(1, 4, 0.0);
  row.row.arrays = {{"values", values}};
  store({row});
  const std::vector<double> seen = reals("SELECT value FROM elements ORDER BY position");
  ASSERT_EQ(seen.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(seen[i], values[i]) << i;
  EXPECT_EQ(reals("SELECT count(*) FROM elements WHERE cell = 'b' AND repetition = 4 AND name = 'values'")[0],
            static_cast<double>(values.size()));
}

TEST_F(Views, ANaNIsNullInElementsAndMetrics) {
  ComputedRow row = example_row(0, 0, std::nan("1"));
  store({row});
  EXPECT_EQ(reals("SELECT count(*) FROM elements WHERE value IS NULL")[0], 3.0);
  EXPECT_EQ(reals("SELECT count(*) FROM metrics WHERE value IS NULL")[0], 1.0);
}

TEST_F(Views, ScalarsGiveMeanAndSampleStandardDeviation) {
  store({example_row(0, 0, 1.0), example_row(0, 1, 2.0), example_row(0, 2, 6.0), example_row(1, 0, 9.0)});
  const std::vector<double> seen = reals(
      "SELECT n, mean, standard_deviation, smallest, largest FROM scalars WHERE name = 'z' AND cell = 'a'");
  ASSERT_EQ(seen.size(), 5U);
  EXPECT_EQ(seen[0], 3.0);
  EXPECT_DOUBLE_EQ(seen[1], 3.0);
  EXPECT_NEAR(seen[2], std::sqrt(7.0), 1e-14);  // ((1-3)^2 + (2-3)^2 + (6-3)^2) / 2
  EXPECT_EQ(seen[3], 1.0);
  EXPECT_EQ(seen[4], 6.0);
}

// Two lines with two outputs and one input: four elements; the errors are chosen by hand.
ComputedRow estimate(std::uint64_t repetition, std::vector<double> re, std::vector<double> im,
                     std::vector<double> bias) {
  ComputedRow out;
  out.row.key = {0, repetition};
  out.row.metrics = {{"degrees_of_freedom", 10.0}, {"elements_per_line", 2.0}, {"inputs", 1.0}};
  out.row.arrays = {{"error_re", std::move(re)},
                    {"error_im", std::move(im)},
                    {"variance", {1.0, 1.0, 4.0, 1.0}},
                    {"bias", std::move(bias)}};
  return out;
}

TEST_F(Views, BiasIsTheMeanErrorOfEachElementWithItsStandardError) {
  store({estimate(0, {3.0, 0.0, 1.0, 0.0}, {4.0, 0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 0.5}),
         estimate(1, {1.0, 0.0, 1.0, 0.0}, {0.0, 0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 0.1})});
  const std::vector<double> first =
      reals("SELECT error_re, error_im, error_abs, standard_error FROM bias WHERE line = 0 AND output = 0");
  // mean 2 + 2i; each run is 1 + 2i away from it: variance 10 over the two runs, of the mean 5
  ASSERT_EQ(first.size(), 4U);
  EXPECT_DOUBLE_EQ(first[0], 2.0);
  EXPECT_DOUBLE_EQ(first[1], 2.0);
  EXPECT_DOUBLE_EQ(first[2], std::sqrt(8.0));
  EXPECT_NEAR(first[3], std::sqrt(5.0), 1e-14);
  EXPECT_EQ(reals("SELECT line, output, input FROM bias"),
            (std::vector<double>{0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0}));
  EXPECT_NEAR(reals("SELECT mean_estimated_bias FROM bias WHERE line = 1 AND output = 1")[0], 0.3, 1e-15);
}

TEST_F(Views, CoverageComparesWithTheQuantileOfTheStudyAndCountsFailuresAsOutside) {
  const double edge = std::sqrt(f_quantile_2_2q(0.95, 10));  // |e| with variance 1 on the rim of the region
  ComputedRow failed = estimate(1, {}, {}, {});
  failed.row.outcome = "singular";
  failed.row.metrics.clear();
  failed.row.arrays.clear();
  store({estimate(0, {edge * 0.999, edge * 1.001, 0.0, edge + 0.2}, {0.0, 0.0, 2.0 * edge * 1.001, 0.0},
                  {0.0, 0.0, 0.0, 0.5}),
         failed});
  const std::vector<double> seen =
      reals("SELECT trials, plain, extended, extended_as_printed FROM coverage WHERE level = 0.95");
  ASSERT_EQ(seen.size(), 4U);
  EXPECT_EQ(seen[0], 2.0);
  EXPECT_DOUBLE_EQ(seen[1], 0.25 / 2.0);  // only the first element is inside
  EXPECT_DOUBLE_EQ(seen[2], 0.5 / 2.0);   // and the fourth, less its bias
  EXPECT_DOUBLE_EQ(seen[3], 0.5 / 2.0);
  EXPECT_EQ(reals("SELECT count(*) FROM coverage")[0], 4.0);
}

TEST_F(Views, CslSharesAreOfAllTrialsAndQuartilesOfThoseWithAValue) {
  const auto confidence = [](std::uint64_t repetition, double p) {
    ComputedRow out;
    out.row.key = {0, repetition};
    out.row.metrics = {{"p_total_ssv", p}};
    return out;
  };
  ComputedRow failed = confidence(5, 0.0);
  failed.row.outcome = "diverged";
  failed.row.metrics.clear();
  store({confidence(0, 0.0), confidence(1, 0.5), confidence(2, 0.95), confidence(3, 0.995),
         confidence(4, 0.999), failed});
  const std::vector<double> seen = reals(
      "SELECT trials, n, smallest, quarter, median, share_above_90, share_above_99, share_zero FROM csl");
  EXPECT_EQ(seen, (std::vector<double>{6, 5, 0.0, 0.5, 0.95, 3.0 / 6.0, 2.0 / 6.0, 1.0 / 6.0}));
}

TEST_F(Views, StrictTablesRefuseValuesOfAnotherKind) {
  store({example_row(0, 0, 1.0)});
  SQLite::Database db(path_, SQLite::OPEN_READWRITE);
  EXPECT_THROW(db.exec("UPDATE trial SET attempts = 'many'"), SQLite::Exception);
  EXPECT_THROW(db.exec("UPDATE cell SET repetitions = 1.5"), SQLite::Exception);
}

}  // namespace
}  // namespace fatmc
