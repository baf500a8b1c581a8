#include "coordinator/input/mat_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <matio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "coordinator/input/record_file.h"

namespace fatmc {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Every test runs on level 5, plain and compressed, and on 7.3.
struct Form {
  mat_ft version;
  matio_compression compression;
  const char* name;
};

class MatFile : public ::testing::TestWithParam<Form> {
 protected:
  MatFile() {
    std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::replace(name.begin(), name.end(), '/', '_');
    folder_ = std::filesystem::temp_directory_path() / ("fatmc_mat_" + name);
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    path_ = (folder_ / "record.mat").string();
    file_ = Mat_CreateVer(path_.c_str(), nullptr, GetParam().version);
  }
  ~MatFile() override {
    close();
    std::filesystem::remove_all(folder_);
  }

  template <typename T>
  void add(const char* name, matio_classes kind, matio_types type, std::size_t rows, std::size_t columns,
           const std::vector<T>& values) {
    std::array<std::size_t, 2> dims = {rows, columns};
    put(Mat_VarCreate(name, kind, type, 2, dims.data(), const_cast<T*>(values.data()), 0));
  }
  void add(const char* name, std::size_t rows, std::size_t columns, const std::vector<double>& values) {
    add(name, MAT_C_DOUBLE, MAT_T_DOUBLE, rows, columns, values);
  }
  void put(matvar_t* variable) {
    ASSERT_NE(variable, nullptr);
    ASSERT_EQ(Mat_VarWrite(file_, variable, GetParam().compression), 0);
    Mat_VarFree(variable);
  }
  void close() {
    if (file_ != nullptr) Mat_Close(file_);
    file_ = nullptr;
  }
  std::string error(const std::vector<std::string>& wanted) {
    close();
    const Result<MatChannels> read = read_mat_channels(path_, wanted);
    return read ? "accepted" : read.error().text();
  }
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }

  std::filesystem::path folder_;
  std::string path_;
  mat_t* file_ = nullptr;
};

TEST_P(MatFile, GivesVectorsOfEitherOrientationAndColumnsOfMatrices) {
  add("row", 1, 3, {1.5, 2.0, -3.0});
  add("column", 3, 1, {0.1, 0.2, 0.3});
  add("y", 3, 2, {1.0, 2.0, 3.0, 10.0, 20.0, 30.0});
  close();
  const Result<MatChannels> read = read_mat_channels(path_, {"y(2)", "row", "column", "y(1)", "row"});
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_THAT(read->columns.names, ElementsAre("y(2)", "row", "column", "y(1)"));
  Eigen::MatrixXd expected(3, 4);
  expected << 10.0, 1.5, 0.1, 1.0, 20.0, 2.0, 0.2, 2.0, 30.0, -3.0, 0.3, 3.0;
  EXPECT_EQ(read->columns.values, expected);
}

TEST_P(MatFile, ConvertsEveryNumericClass) {
  add<float>("single", MAT_C_SINGLE, MAT_T_SINGLE, 2, 1, {0.25F, -1.5F});
  add<std::int16_t>("counts", MAT_C_INT16, MAT_T_INT16, 2, 1, {-32768, 32767});
  add<std::uint8_t>("byte", MAT_C_UINT8, MAT_T_UINT8, 2, 1, {0, 255});
  add<std::int32_t>("long", MAT_C_INT32, MAT_T_INT32, 2, 1, {-2147483647, 5});
  close();
  const Result<MatChannels> read = read_mat_channels(path_, {"single", "counts", "byte", "long"});
  ASSERT_TRUE(read) << read.error().text();
  Eigen::MatrixXd expected(2, 4);
  expected << 0.25, -32768.0, 0.0, -2147483647.0, -1.5, 32767.0, 255.0, 5.0;
  EXPECT_EQ(read->columns.values, expected);
}

TEST_P(MatFile, SaysWhatItHoldsWhereANameIsMissing) {
  add("u", 2, 1, {1.0, 2.0});
  add("fs", 1, 1, {50.0});
  close();
  const Result<MatChannels> read = read_mat_channels(path_, {"u", "nowhere"});
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_THAT(read->columns.names, ElementsAre("u"));
  EXPECT_THAT(read->variables, ::testing::UnorderedElementsAre("u", "fs"));
}

TEST_P(MatFile, RefusesWhatIsNoRealVector) {
  const std::vector<double> re = {1.0, 2.0}, im = {0.0, 1.0};
  mat_complex_split_t split = {const_cast<double*>(re.data()), const_cast<double*>(im.data())};
  std::array<std::size_t, 2> dims = {2, 1}, one = {1, 1};
  put(Mat_VarCreate("phasor", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims.data(), &split, MAT_F_COMPLEX));
  const char* fields[] = {"y"};
  matvar_t* data = Mat_VarCreateStruct("data", 2, one.data(), fields, 1);
  Mat_VarSetStructFieldByName(
      data, "y", 0,
      Mat_VarCreate("y", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims.data(), const_cast<double*>(re.data()), 0));
  put(data);
  add("y", 2, 2, {1.0, 2.0, 3.0, 4.0});
  add("u", 2, 1, {1.0, 2.0});
  add("long", 1, 5, {1.0, 2.0, 3.0, 4.0, 5.0});
  add("wide", 3, 2, {1.0, 2.0, 3.0, 4.0, 5.0, 6.0});
  std::array<std::size_t, 3> cube = {2, 1, 2};
  const std::vector<double> four = {1.0, 2.0, 3.0, 4.0};
  put(Mat_VarCreate("cube", MAT_C_DOUBLE, MAT_T_DOUBLE, 3, cube.data(), const_cast<double*>(four.data()), 0));
  EXPECT_THAT(error({"phasor"}), AllOf(HasSubstr("record.mat: phasor: is complex")));
  EXPECT_THAT(error({"data"}), HasSubstr("data: is a struct"));
  EXPECT_THAT(error({"cube"}), HasSubstr("cube: has 3 dimensions"));
  EXPECT_THAT(error({"y"}), HasSubstr("y: is a matrix of 2 x 2, name a column of it, for instance y(1)"));
  EXPECT_THAT(error({"y(3)"}), HasSubstr("y(3): the variable is 2 x 2, there is no such column"));
  EXPECT_THAT(error({"long(2)"}), HasSubstr("long(2): the variable is 1 x 5, name it without an index"));
  EXPECT_THAT(error({"u", "long"}), HasSubstr("long: has 5 samples, u has 2"));
  EXPECT_THAT(error({"u", "wide(1)"}), HasSubstr("wide(1): runs along the rows (3 x 2), transpose it"));
}

TEST_P(MatFile, LeavesOutATimeThatIsNone) {
  add("u", 3, 1, {1.0, 2.0, 3.0});
  add("t", 1, 2, {0.0, 1.0});
  close();
  const Result<MatChannels> read = read_mat_channels(path_, {"u", "t"});
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_THAT(read->columns.names, ElementsAre("u"));
}

TEST_P(MatFile, IsRefusedInOneLineWhereItIsCutShort) {
  std::vector<double> values(5000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sin(static_cast<double>(i * i));
  add("u", values.size(), 1, values);
  close();
  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) / 2);
  const std::string text = error({"u"});
  EXPECT_THAT(text, HasSubstr("record.mat: "));
  EXPECT_EQ(text.find('\n'), std::string::npos);
}

TEST_P(MatFile, MakesTheRecordThatTheCsvMakes) {
  const std::size_t n = 200;
  std::vector<double> t(n), r(n), y(2 * n);
  std::string csv = "t,r,u,p,q\n";
  const auto text = [](double value) {
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, "%.17g", value);
    return std::string(buffer);
  };
  for (std::size_t i = 0; i < n; ++i) {
    const double phase = 2.0 * 3.14159265358979 * static_cast<double>(i % 100) / 100.0;
    t[i] = 0.02 * static_cast<double>(i);
    r[i] = std::cos(3.0 * phase) + std::cos(7.0 * phase + 1.0);
    y[i] = 2.0 * r[i] + 0.01 * static_cast<double>(i % 3);
    y[n + i] = -r[i] / 3.0;
    csv += text(t[i]) + "," + text(r[i]) + "," + text(0.5 * r[i]) + "," + text(y[i]) + "," + text(y[n + i]) +
           "\n";
  }
  std::vector<double> u = r;
  for (double& value : u) value *= 0.5;
  add("t", 1, n, t);
  add("r", n, 1, r);
  add("u", 1, n, u);
  add("y", n, 2, y);
  close();
  const std::string roles = "[record]\nreference = [\"r\"]\ninput = [\"u\"]\nperiod_samples = 100\n";
  const std::string csv_path = write("plain.csv", csv);
  write("plain.toml", roles + "output = [\"p\", \"q\"]\n");
  write("record.toml", roles + "output = [\"y(1)\", \"y(2)\"]\n");
  Result<Record> from_mat = read_record(path_), from_csv = read_record(csv_path);
  ASSERT_TRUE(from_mat) << from_mat.error().text();
  ASSERT_TRUE(from_csv) << from_csv.error().text();
  EXPECT_EQ(from_mat->rate_hz, from_csv->rate_hz);
  EXPECT_EQ(from_mat->periods, 2);
  EXPECT_EQ(from_mat->channels(from_mat->reference), from_csv->channels(from_csv->reference));
  EXPECT_EQ(from_mat->channels(from_mat->input), from_csv->channels(from_csv->input));
  EXPECT_EQ(from_mat->channels(from_mat->output), from_csv->channels(from_csv->output));
}

TEST_P(MatFile, NamesSamplesWhereACsvHasLines) {
  add("t", 5, 1, {0.0, 0.1, 0.2, 0.5, 0.6});
  add("u", 5, 1, {1.0, 2.0, 3.0, 1.0, 2.0});
  add("y", 5, 1, {1.0, 2.0, std::nan(""), 1.0, 2.0});
  close();
  write("record.toml", "[record]\ninput = [\"u\"]\noutput = [\"y\"]\n");
  EXPECT_THAT(read_record(path_).error().text(), HasSubstr("record.mat: t: sample 4: gap"));
  const std::string rated = write("rated.toml", "[record]\ninput = [\"u\"]\noutput = [\"z\"]\n");
  EXPECT_THAT(read_record(path_, rated).error().text(),
              AllOf(HasSubstr("rated.toml:3: record.output"),
                    HasSubstr("the MAT file has no variable \"z\", it has")));
}

INSTANTIATE_TEST_SUITE_P(Versions, MatFile,
                         ::testing::Values(Form{MAT_FT_MAT5, MAT_COMPRESSION_NONE, "Level5"},
                                           Form{MAT_FT_MAT5, MAT_COMPRESSION_ZLIB, "Compressed"},
                                           Form{MAT_FT_MAT73, MAT_COMPRESSION_NONE, "Hdf5"}),
                         [](const auto& version) { return std::string(version.param.name); });

TEST(MatFileName, IsToldByItsEnding) {
  EXPECT_TRUE(is_mat_file("a/flight.mat"));
  EXPECT_TRUE(is_mat_file("FLIGHT.MAT"));
  EXPECT_FALSE(is_mat_file("mat.csv"));
  EXPECT_FALSE(is_mat_file("mat"));
}

TEST(MatFileName, OfSomethingElseIsRefused) {
  const auto path = std::filesystem::temp_directory_path() / "fatmc_no.mat";
  std::ofstream(path) << "u,y\n1,2\n";
  const Result<MatChannels> read = read_mat_channels(path.string(), {"u"});
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().text(), HasSubstr("is no MAT file that can be read"));
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace fatmc
