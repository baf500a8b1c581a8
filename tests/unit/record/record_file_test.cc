#include "coordinator/input/record_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/base/text.h"
#include "core/random/random_stream.h"
#include "core/record/column_file.h"
#include "core/signal/multisine.h"

namespace fatmc {
namespace {

using ::testing::HasSubstr;

/// A folder of its own for each test.
class RecordFile : public ::testing::Test {
 protected:
  RecordFile() {
    folder_ = std::filesystem::temp_directory_path() /
              (std::string("fatmc_record_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~RecordFile() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  /// A CSV with reference r, input u, output y of two periods of 100 samples, one row changed by `edit`.
  std::string csv(int rows = 200, const std::string& replacement = "", int line = 0, bool time = false) {
    RandomStream stream({1, 0, 0, 0}, "test");
    const std::vector<double> r = Multisine::random_phase(100, {2, 5, 9, 14}, 1.0, stream).samples(3);
    std::string text = time ? "t,r,u,y\n" : "r,u,y\n";
    for (int i = 0; i < rows; ++i) {
      const double value = r[static_cast<std::size_t>(i)];
      std::string row = shortest(value) + "," + shortest(0.5 * value) + "," + shortest(2.0 * value);
      if (time) row = shortest(i * 0.02) + "," + row;
      text += (i + 2 == line ? replacement : row) + "\n";
    }
    return write("record.csv", text);
  }
  std::string toml(const std::string& more = "", const std::string& roles = kRoles) {
    return write("record.toml", "[record]\n" + roles + more);
  }
  std::string error(const std::string& path) {
    Result<Record> record = read_record(path);
    if (!record) return record.error().text();
    const Status status = complete_period(*record, path);
    return status ? "accepted" : status.error().text();
  }

  static constexpr const char* kRoles = "reference = [\"r\"]\ninput = [\"u\"]\noutput = [\"y\"]\n";
  static constexpr const char* kRate = "rate_hz = 50.0\n";
  std::filesystem::path folder_;
};

TEST_F(RecordFile, IsReadWithRolesPeriodAndLines) {
  toml(kRate);
  const std::string path = csv();
  Result<Record> record = read_record(path);
  ASSERT_TRUE(record) << record.error().text();
  ASSERT_TRUE(complete_period(*record, path));
  EXPECT_EQ(record->period_samples, 100);
  EXPECT_EQ(record->periods, 2);
  EXPECT_EQ(record->excited_lines, (std::vector<int>{2, 5, 9, 14}));
  EXPECT_EQ(record->output, std::vector<int>{2});
  EXPECT_EQ(record->rate_hz, 50.0);
}

TEST_F(RecordFile, TakesEveryKeyOfTheContract) {
  toml("rate_hz = 50.0\nauxiliary = []\nperiod_samples = 100\nperiods = 2\nexcited_lines = [2, 5, 9]\n"
       "controller_gain = [[0.1]]\nhold = \"continuous\"\n");
  const Result<Record> record = read_record(csv());
  ASSERT_TRUE(record) << record.error().text();
  EXPECT_EQ(record->excited_lines, (std::vector<int>{2, 5, 9}));
  EXPECT_EQ((*record->controller_gain)(0, 0), 0.1);
  EXPECT_EQ(record->hold, Hold::continuous);
}

TEST_F(RecordFile, TakesItsRateFromTime) {
  toml();
  const Result<Record> record = read_record(csv(200, "", 0, true));
  ASSERT_TRUE(record) << record.error().text();
  EXPECT_NEAR(record->rate_hz, 50.0, 1e-9);
}

TEST_F(RecordFile, RefusesWhatIsNotANumber) {
  toml(kRate);
  EXPECT_THAT(error(csv(200, "1,nan,3", 17)), HasSubstr("record.csv:17: u: \"nan\" is not a finite number"));
  EXPECT_THAT(error(csv(200, "1,,3", 18)), HasSubstr("record.csv:18: u: the value is missing"));
  EXPECT_THAT(error(csv(200, "1,2", 19)), HasSubstr("record.csv:19: 2 values where the header names 3"));
  EXPECT_THAT(error(csv(200, "1,2,3,4", 20)), HasSubstr("record.csv:20: 4 values"));
  EXPECT_THAT(error(csv(200, "", 21)), HasSubstr("record.csv:21: is empty"));
}

TEST_F(RecordFile, RefusesGapsAndUnequalSteps) {
  toml();
  EXPECT_THAT(error(csv(200, "7,1,2,3", 30, true)), HasSubstr("record.csv:30: t: gap"));
  EXPECT_THAT(error(csv(200, "0.57,1,2,3", 30, true)), HasSubstr("unequal steps"));
  EXPECT_THAT(error(csv(200, "0.2,1,2,3", 30, true)), HasSubstr("does not ascend"));
}

TEST_F(RecordFile, RefusesHalfAPeriod) {
  toml(kRate + std::string("period_samples = 100\n"));
  EXPECT_THAT(error(csv(250)), HasSubstr("2.5 periods of 100, cut it to whole periods (200 samples)"));
  toml(kRate);
  EXPECT_THAT(error(csv(250)), HasSubstr("2.5 periods of 100"));
}

TEST_F(RecordFile, RefusesAReferenceThatDoesNotRepeat) {
  toml(kRate + std::string("period_samples = 50\n"));
  EXPECT_THAT(error(csv()), HasSubstr("does not repeat after 50 samples"));
  toml(kRate);
  EXPECT_THAT(error(csv(100)), HasSubstr("does not repeat within the record"));
}

TEST_F(RecordFile, RefusesADeadChannel) {
  toml(kRate);
  std::string text = "r,u,y\n";
  for (int i = 0; i < 200; ++i) text += shortest(std::cos(0.5 * i)) + ",0.25,1\n";
  EXPECT_THAT(error(write("record.csv", text)), HasSubstr("u: dead channel: every sample is 0.25"));
}

TEST_F(RecordFile, NamesColumnsAndKeysThatDoNotExist) {
  const std::string path = csv();
  toml(kRate, "input = [\"u\"]\noutput = [\"z\"]\n");
  EXPECT_THAT(error(path), HasSubstr("record.toml:3: record.output: the CSV has no column \"z\", it has r, u, y"));
  toml("rate_hz = 50.0\nrates = 3\n");
  EXPECT_THAT(error(path), HasSubstr("record.toml:6: record.rates"));
  toml();
  EXPECT_THAT(error(path), HasSubstr("rate_hz"));
  toml("rate_hz = -1.0\n");
  EXPECT_THAT(error(path), HasSubstr("record.rate_hz"));
  toml("rate_hz = 50.0\nperiods = 3\nperiod_samples = 100\n");
  EXPECT_THAT(error(path), HasSubstr("3 periods of 100 samples are announced, the record holds 2"));
  std::filesystem::remove(folder_ / "record.toml");
  EXPECT_THAT(error(path), HasSubstr("record.toml: does not exist"));
}

TEST_F(RecordFile, SkipsLeadingPeriods) {
  toml(kRate + std::string("period_samples = 100\n"));
  Record record = read_record(csv(300)).value();
  const double value = record.samples(100, 0);
  ASSERT_TRUE(skip_periods(record, 1, "record.csv"));
  EXPECT_EQ(record.periods, 2);
  EXPECT_EQ(record.sample_count(), 200);
  EXPECT_EQ(record.samples(0, 0), value);
  EXPECT_THAT(skip_periods(record, 1, "record.csv").error().text(), HasSubstr("leave fewer than 2"));
}

TEST_F(RecordFile, ReadsBackBitForBitWhatWasWritten) {
  RandomStream stream({2, 0, 0, 0}, "test");
  Eigen::MatrixXd values(500, 3);
  for (auto& v : values.reshaped()) v = stream.normal() * std::pow(10.0, 40.0 * stream.uniform() - 20.0);
  const std::string path = (folder_ / "values.csv").string();
  write_columns(path, {"a", "b", "c"}, values);
  const Columns columns = read_columns(path).value();
  EXPECT_TRUE((columns.values.array() == values.array()).all());
  EXPECT_EQ(columns.names, (std::vector<std::string>{"a", "b", "c"}));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1) << "no temporary file is left";
}

TEST_F(RecordFile, RefusesHeadersWithoutNames) {
  EXPECT_THAT(read_columns(write("x.csv", "1,2\n3,4\n")).error().text(), HasSubstr("must name the columns"));
  EXPECT_THAT(read_columns(write("x.csv", "a,a\n3,4\n")).error().text(), HasSubstr("two columns"));
  EXPECT_THAT(read_columns((folder_ / "none.csv").string()).error().text(), HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace fatmc
