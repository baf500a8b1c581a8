#include "campaigns/coverage/snr_summary.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random/random_stream.h"
#include "tests/unit/studies/shipped.h"

namespace fatmc::coverage {
namespace {

/// Two lines of one input: the second 10 dB above the first.
SnrSummary summary_of(const std::vector<double>& first_line_db) {
  SnrSummary out;
  for (const double snr : first_line_db) out.add({snr, snr + 10.0}, 1);
  return out;
}

std::vector<TableRow> rows_of(const SnrSummary& summary, std::uint64_t trials,
                              const std::vector<PublishedFigure>& published = {}) {
  std::vector<TableRow> out;
  summary.add_rows(trials, "", published, out);
  return out;
}

std::vector<double> normal_snr(std::size_t runs) {
  RandomStream random(TrialSeed{2018, name_hash("snr"), 0, 0}, "snr");
  std::vector<double> out;
  for (std::size_t run = 0; run < runs; ++run) out.push_back(22.0 + random.normal());
  return out;
}

const std::vector<PublishedFigure> kPrinted = {
    {"Section 5.2.3", "input 1", "smallest input SNR", "dB", 19.8, false, ""},
    {"Section 5.2.3", "input 1", "smallest median", "dB", 22.0, false, ""}};

TEST(SnrSummary, CountsRunsWithoutAnEstimateAsBelowTheLimit) {
  const auto out = rows_of(summary_of({21.0, 19.0, 22.0, 23.0, 21.0, 24.0, 22.0, 25.0}), 10);
  const TableRow& share =
      test::find(out, "Section 5.2.3", "input 1", "share of all runs with a line below 20 dB");
  EXPECT_DOUBLE_EQ(share.value, 30.0);  // one, and the two that failed
  EXPECT_EQ(share.n, 10U);
  EXPECT_EQ(test::find(out, "Section 5.2.3", "input 1", "smallest median").n, 8U);
  EXPECT_DOUBLE_EQ(test::find(out, "Section 5.2.3", "input 1", "smallest median").value, 22.0);
  EXPECT_DOUBLE_EQ(test::find(out, "Section 5.2.3", "input 1", "largest median").value, 32.0);
}

TEST(SnrSummary, GivesNoVerdictOnASmallestValueOfFewerRunsThanPrint) {
  const auto few = rows_of(summary_of(normal_snr(49)), 49, kPrinted);
  const TableRow& row = test::find(few, "Section 5.2.3", "input 1", "smallest input SNR");
  EXPECT_EQ(row.verdict, "");
  EXPECT_TRUE(std::isnan(row.low));
  EXPECT_NE(row.why.find("smallest of 49 runs"), std::string::npos);
}

TEST(SnrSummary, ComparesASmallestValueWithThatOfBlocksAsLargeAsPrint) {
  const auto enough = rows_of(summary_of(normal_snr(50)), 50, kPrinted),
             many = rows_of(summary_of(normal_snr(2500)), 2500, kPrinted);
  const TableRow &of_50 = test::find(enough, "Section 5.2.3", "input 1", "smallest input SNR"),
                 &of_2500 = test::find(many, "Section 5.2.3", "input 1", "smallest input SNR");
  EXPECT_EQ(of_50.verdict, "match");
  EXPECT_NE(of_50.why.find("normal law"), std::string::npos);
  // E min of 50 normal values: 2.249 deviations below their mean; the whole sample's smallest lies further down.
  EXPECT_NEAR(of_2500.value, 22.0 - 2.249, 3.0 * 0.47 / std::sqrt(50.0));
  EXPECT_EQ(of_2500.why.find("normal law"), std::string::npos);  // from ranks alone
  EXPECT_GT(of_2500.high, 22.0 - 1.467 - 0.2);  // the law's own 2.5 % points: 3.287 and 1.467
  EXPECT_NEAR(of_2500.low, 22.0 - 3.287, 0.5);
}

TEST(SnrSummary, SaysThatPrintedFiguresWereFitted) {
  const auto out = rows_of(summary_of(normal_snr(50)), 50, kPrinted);
  for (const char* quantity : {"smallest input SNR", "smallest median"})
    EXPECT_EQ(test::find(out, "Section 5.2.3", "input 1", quantity).why.find("fitted"), 0U);
  EXPECT_EQ(test::find(out, "Section 5.2.3", "input 1", "largest median").why, "");
}

}  // namespace
}  // namespace fatmc::coverage
