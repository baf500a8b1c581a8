#include "coordinator/input/factor_file.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

namespace fatmc {
namespace {

constexpr const char* kHeader = "id,Xre11,Xim11,Xre12,Xim12,w_out1_in1,w_out2_in1\n";

class FactorFile : public ::testing::Test {
 protected:
  Result<std::vector<LoopFactors>> read(const std::string& text) {
    std::ofstream(path_) << text;
    return read_loop_factors(path_);
  }
  std::string error(const std::string& text) {
    const auto loops = read(text);
    return loops ? "" : loops.error().text();
  }
  void TearDown() override { std::remove(path_.c_str()); }
  const std::string path_ = ::testing::TempDir() + "factors_" +
                            ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".csv";
};

TEST_F(FactorFile, GivesLoopsOfTheSizeThatTheHeaderNames) {
  const auto loops = read(std::string(kHeader) + "a,1,2,3,4,5,6\r\nb,-1,0,1e-3,0,0,0\n\n");
  ASSERT_TRUE(loops.has_value()) << loops.error().text();
  ASSERT_EQ(loops->size(), 2u);
  const LoopFactors& a = loops->front();
  EXPECT_EQ(a.id, "a");
  ASSERT_EQ(a.x.rows(), 1);
  ASSERT_EQ(a.x.cols(), 2);
  EXPECT_EQ(a.x(0, 1), std::complex<double>(3.0, 4.0));
  EXPECT_EQ(a.radii(1, 0), 6.0);
}

TEST_F(FactorFile, TakesColumnsInAnyOrder) {
  const auto loops = read("w_out1_in1,Xim11,id,Xre11\n7,2,z,1\n");
  ASSERT_TRUE(loops.has_value()) << loops.error().text();
  EXPECT_EQ(loops->front().x(0, 0), std::complex<double>(1.0, 2.0));
  EXPECT_EQ(loops->front().radii(0, 0), 7.0);
}

TEST_F(FactorFile, NamesLineAndColumnOfABadValue) {
  EXPECT_EQ(error(std::string(kHeader) + "a,1,2,3,4,5,6\nb,1,2,3,nan,5,6\n"),
            path_ + ":3: Xim12: 'nan' is not a finite number");
  EXPECT_EQ(error(std::string(kHeader) + "a,1,2,3,4,5,-6\n"),
            path_ + ":2: w_out2_in1: -6 is negative; a radius is not");
  EXPECT_EQ(error(std::string(kHeader) + "a,1,2,3\n"), path_ + ":2: has 4 values for 7 columns");
}

TEST_F(FactorFile, NamesAColumnThatIsMissingDoubleOrUnknown) {
  EXPECT_EQ(error("id,Xre11,Xim11,w_out1_in1,w_out2_in1\n"),
            path_ + ":1: Xre12: is missing: other columns speak of 1 inputs and 2 outputs");
  EXPECT_EQ(error("id,Xre11,Xim11,Xim11,w_out1_in1\n"), path_ + ":1: Xim11: stands there more than once");
  EXPECT_NE(error("id,Xre11,Xim11,w11\n").find(path_ + ":1: w11: is not a column"), std::string::npos);
  EXPECT_NE(error("id,Xre11,Xim11,w_out1_in1\n").find("no row"), std::string::npos);
}

}  // namespace
}  // namespace fatmc
