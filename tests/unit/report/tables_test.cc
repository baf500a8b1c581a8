#include "coordinator/report/tables.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "coordinator/cli/progress_line.h"

namespace fatmc {
namespace {

const std::vector<TableRow> kRows = {
    {"5-5", "95 %", "element-wise", "%", 94.5, 95.25, 94.0, 95.5, 50, "match", ""},
    {"5-5", "99 %", "joint", "%", std::nan(""), 98.0, std::nan(""), std::nan(""), 50, "", "not printed"}};

TEST(Tables, JsonHasTheKeysOfTheContractAndNullForNaN) {
  const auto json = nlohmann::ordered_json::parse(format_tables(kRows, TableFormat::json));
  ASSERT_EQ(json.size(), 2U);
  std::vector<std::string> keys;
  for (const auto& [key, value] : json[0].items()) keys.push_back(key);
  EXPECT_EQ(keys, (std::vector<std::string>{"table", "row", "quantity", "unit", "published", "value", "low",
                                            "high", "n", "verdict", "why"}));
  EXPECT_EQ(json[0]["value"], 95.25);
  EXPECT_TRUE(json[1]["published"].is_null());
  EXPECT_EQ(json[1]["n"], 50);
}

TEST(Tables, TextIsABlockATableWithAlignedColumnsAndReasonsBelow) {
  EXPECT_EQ(format_tables(kRows, TableFormat::text),
            "Table 5-5\n"
            "row   quantity      unit  published  ours  95 % interval   n  verdict\n"
            "95 %  element-wise  %          94.5  95.2   94.0 to 95.5  50  match\n"
            "99 %  joint         %             -  98.0              -  50  [1]\n"
            "  [1] not printed\n");
}

TEST(Tables, ShowAsManyDigitsAsTheVerdictNeeds) {
  const auto line_of = [](double published, double value, double low, double high, const char* unit,
                          const char* verdict) {
    const TableRow row = {"T", "r", "q", unit, published, value, low, high, 50, verdict, ""};
    const std::string text = format_tables({row}, TableFormat::markdown);
    return text.substr(text.rfind("| r"));
  };
  EXPECT_NE(line_of(100.0, 99.7, 99.5, 99.998, "%", "differs").find("| 99.5 to 99.998 |"), std::string::npos);
  EXPECT_NE(line_of(25.0, 25.3, 25.02, 26.0, "%", "differs").find("| 25.02 to 26.0 |"), std::string::npos);
  EXPECT_NE(line_of(25.0, 25.01, 25.004, 26.0, "%", "differs").find(" 25.01 | 25.004 to 26.0 |"),
            std::string::npos);
  EXPECT_NE(line_of(0.8, 0.9, 0.80003, 1.0, "", "differs").find(" 0.80003 to 1 |"), std::string::npos);
  // An end that is the printed figure holds it; a match inside rounded ends as well.
  EXPECT_NE(line_of(100.0, 99.0, 98.0, 100.0, "%", "match").find(" 98.0 to 100.0 |"), std::string::npos);
  EXPECT_NE(line_of(25.0, 25.01, 24.0, 26.0, "%", "match").find(" 25.0 |  24.0 to 26.0 |"), std::string::npos);
}

TEST(Tables, MarkdownHasARuleUnderItsHeader) {
  const std::string text = format_tables(kRows, TableFormat::markdown);
  EXPECT_EQ(text.substr(0, 18), "### Table 5-5\n\n| r");
  EXPECT_NE(text.find("\n|---"), std::string::npos);
}

TEST(RateMeter, ForgetsWhatIsLongPast) {
  cli::RateMeter meter;
  for (int second = 0; second <= 100; ++second) {
    const double done = second <= 50 ? second * 1.0 : 50.0 + (second - 50) * 8.0;
    meter.add(cli::RateMeter::Seconds(second), static_cast<std::uint64_t>(done));
  }
  EXPECT_DOUBLE_EQ(meter.per_second(), 8.0);
  EXPECT_DOUBLE_EQ(meter.seconds_left(80), 10.0);
}

TEST(RateMeter, OfLongTrialsIsTakenOverSeveral) {
  cli::RateMeter meter;
  for (int second = 0; second <= 1000; ++second)  // one trial every hundred seconds
    meter.add(cli::RateMeter::Seconds(second), static_cast<std::uint64_t>(second / 100));
  EXPECT_NEAR(meter.per_second(), 0.01, 0.001);
  EXPECT_NEAR(meter.seconds_left(5), 500.0, 50.0);
}

TEST(RateMeter, KnowsNothingAtFirst) {
  EXPECT_LT(cli::RateMeter().seconds_left(10), 0.0);
  EXPECT_EQ(cli::clock_text(-1.0), "?");
}

TEST(ClockText, IsReadAsAClock) {
  EXPECT_EQ(cli::clock_text(6.2), "0:07");
  EXPECT_EQ(cli::clock_text(750.0), "12:30");
  EXPECT_EQ(cli::clock_text(11100.0), "3:05:00");
}

TEST(ProgressText, SaysHowFarHowFastAndHowPrecise) {
  cli::RateMeter meter;
  meter.add(cli::RateMeter::Seconds(0), 0);
  meter.add(cli::RateMeter::Seconds(2), 100);
  cli::Progress progress;
  progress.done = 100;
  progress.total = 300;
  EXPECT_EQ(cli::progress_text(progress, meter), "100/300 trials, 50/s, ETA 0:04");
  progress.failed = 3;
  progress.precision = "x 0.95 in [0.9, 1]";
  EXPECT_EQ(cli::progress_text(progress, meter),
            "100/300 trials, 3 not ok, 50/s, ETA 0:04, x 0.95 in [0.9, 1]");
  progress.paused = true;
  progress.precision.clear();
  EXPECT_EQ(cli::progress_text(progress, meter), "100/300 trials, 3 not ok, paused (fatmc resume goes on)");
}

}  // namespace
}  // namespace fatmc
