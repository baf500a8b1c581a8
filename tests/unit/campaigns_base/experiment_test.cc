// Excitations of the experiment file.
#include "campaigns/base/experiment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

#include "coordinator/input/toml_file.h"

namespace fatmc {
namespace {

using testing::HasSubstr;

class ExperimentFile : public testing::Test {
 protected:
  Result<Experiment> read(const std::string& excitation) {
    std::ofstream(path_) << "kind = \"experiment\"\n[excitation]\nperiod_s = 200.0\nperiods = 2\n"
                            "ranges_hz = [[0.285, 0.38, 0.005], [0.38, 0.58, 0.01], [0.58, 2.89, 0.07]]\n"
                            "amplitude_rad_s = [0.035, 0.0155, 0.030]\n"
                         << excitation << "[controller]\ngain = [0.1, 0.1, 0.1]\n";
    const Result<Tree> tree = read_toml(path_);
    if (!tree) return fail(tree.error());
    return decode_experiment(*tree, {});
  }
  void TearDown() override { std::remove(path_.c_str()); }
  std::string path_ = testing::TempDir() + "experiment_test_" +
                      testing::UnitTest::GetInstance()->current_test_info()->name() + ".toml";
  TrialSeed seed_{1, 2, 0, 3};
};

TEST_F(ExperimentFile, HasRandomPhasesOnSharedLinesUnlessItSaysOtherwise) {
  const auto experiment = read("");
  ASSERT_TRUE(experiment) << experiment.error().text();
  const auto signals = reference_multisines(*experiment, seed_);
  RandomStream stream(seed_, "excitation");
  for (int axis = 0; axis < 3; ++axis) {
    const Multisine expected = Multisine::random_phase(
        10'000, experiment->excitation.lines,
        experiment->excitation.amplitude_rad_s[static_cast<std::size_t>(axis)], stream);
    EXPECT_EQ(signals[static_cast<std::size_t>(axis)].phases(), expected.phases());
    EXPECT_EQ(signals[static_cast<std::size_t>(axis)].lines().size(), 73U);
  }
}

TEST_F(ExperimentFile, ZipperedLinesGiveEachAxisItsOwn) {
  const auto experiment = read("lines = \"zippered\"\nphases = \"schroeder\"\n");
  ASSERT_TRUE(experiment) << experiment.error().text();
  const auto signals = reference_multisines(*experiment, seed_);
  EXPECT_EQ(signals[0].lines().size() + signals[1].lines().size() + signals[2].lines().size(), 73U);
  EXPECT_EQ(signals[0].lines().front(), 57);
  EXPECT_EQ(signals[1].lines().front(), 58);
  EXPECT_EQ(signals[2].lines().front(), 59);
  EXPECT_EQ(experiment->excitation.lines.size(), 73U);
}

TEST_F(ExperimentFile, LowCrestPhasesAreLowAndDifferFromTrialToTrial) {
  const auto experiment = read("phases = \"low_crest\"\n");
  ASSERT_TRUE(experiment) << experiment.error().text();
  const Multisine first = reference_multisines(*experiment, seed_)[0];
  EXPECT_LT(crest_factor(first.period()), 2.0);
  EXPECT_NE(reference_multisines(*experiment, {1, 2, 0, 4})[0].phases(), first.phases());
}

TEST_F(ExperimentFile, OneSignalForAllAxesIsRefusedWithItsLine) {
  const auto experiment = read("phases = \"schroeder\"\n");
  ASSERT_FALSE(experiment);
  EXPECT_EQ(experiment.error().line, 7);
  EXPECT_THAT(experiment.error().text(), HasSubstr("excitation.phases"));
  EXPECT_THAT(experiment.error().text(), HasSubstr("zippered"));
}

}  // namespace
}  // namespace fatmc
