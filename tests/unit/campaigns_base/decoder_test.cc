#include "campaigns/base/decoder.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

#include "campaigns/base/campaign_spec.h"
#include "coordinator/input/toml_file.h"

namespace fatmc {
namespace {

class TomlFile : public testing::Test {
 protected:
  std::string path_ = testing::TempDir() + "decoder_test_" +
                      testing::UnitTest::GetInstance()->current_test_info()->name() + ".toml";
  Result<Tree> read(const std::string& text) {
    std::ofstream(path_) << text;
    return read_toml_resolved(path_);
  }
  void TearDown() override { std::remove(path_.c_str()); }
};

TEST_F(TomlFile, ASyntaxErrorNamesItsLine) {
  const auto tree = read("a = 1\nb = = 2\n");
  ASSERT_FALSE(tree);
  EXPECT_EQ(tree.error().line, 2);
}

TEST_F(TomlFile, AnUnknownKeyIsReportedWithItsLineAndTheKnownKeys) {
  const auto tree = read("[wing]\nspan_m = 5.0\nspam_m = 4.0\n");
  ASSERT_TRUE(tree);
  Decoder top(*tree, "");
  Decoder wing(*top.table("wing"), "wing");
  EXPECT_EQ(wing.real("span_m", {.low = 0.0, .high = 100.0}), 5.0);
  const Status status = wing.finish();
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().text(), path_ + ":3: wing.spam_m: is not a known key, the keys here are: span_m");
}

TEST_F(TomlFile, AValueOutOfRangeIsReportedWithTheAllowedValues) {
  const auto tree = read("span_m = -1\n");
  Decoder top(*tree, "");
  top.real("span_m", {.low = 0.0, .high = 100.0});
  ASSERT_FALSE(top.finish());
  EXPECT_EQ(top.error()->text(), path_ + ":1: span_m: -1 is out of range, write a value between 0 and 100");
}

TEST_F(TomlFile, AWrongTypeIsReported) {
  const auto tree = read("span_m = \"five\"\n");
  Decoder top(*tree, "");
  top.real("span_m");
  EXPECT_EQ(top.error()->text(), path_ + ":1: span_m: is a string, write a number");
}

TEST_F(TomlFile, AMissingModelFileIsReportedWhereItIsNamed) {
  const auto tree = read("\nmodel = \"nowhere.toml\"\n");
  ASSERT_FALSE(tree);
  EXPECT_EQ(tree.error().line, 2);
  EXPECT_EQ(tree.error().key, "model");
}

TEST_F(TomlFile, AModelThatIsNoFileNameIsReportedWhereItStands) {
  EXPECT_EQ(read("\nmodel = 3\n").error().text(),
            path_ + ":2: model: is an integer, write a file name in quotes");
  const auto folder = read("\n\nmodel = \".\"\n");
  ASSERT_FALSE(folder);
  EXPECT_EQ(folder.error().line, 3);
  EXPECT_EQ(folder.error().key, "model");
  EXPECT_NE(folder.error().text().find("names the folder"), std::string::npos) << folder.error().text();
}

TEST_F(TomlFile, AKeyThatWasOnlyLookedForIsAmongTheKnownKeysOnce) {
  const auto tree = read("lines = 1\nlimes = 2\n");
  Decoder top(*tree, "");
  EXPECT_FALSE(top.has("ranges_hz"));
  EXPECT_TRUE(top.has("lines"));
  EXPECT_EQ(top.integer("lines"), 1);
  ASSERT_FALSE(top.finish());
  EXPECT_EQ(top.error()->text(),
            path_ + ":2: limes: is not a known key, the keys here are: lines, ranges_hz");
}

TEST_F(TomlFile, AWrongTypeHasItsArticle) {
  const auto tree = read("name = 3\nspan_m = [1]\n");
  Decoder top(*tree, "");
  top.text("name");
  EXPECT_EQ(top.error()->text(), path_ + ":1: name: is an integer, write a string");
  Decoder again(*tree, "");
  again.real("span_m");
  EXPECT_EQ(again.error()->text(), path_ + ":2: span_m: is an array, write a number");
}

TEST_F(TomlFile, IdentityIgnoresRepetitionsLinesAndOrderButNotValues) {
  const std::string head = "[campaign]\nstudy = \"s\"\nseed = 1\n";
  const auto identity = [&](const std::string& rest) {
    const auto spec = decode_campaign(*read(head + rest));
    EXPECT_TRUE(spec);
    return spec->identity();
  };
  const std::string base = identity("[x]\na = 1\nb = 2\n[[cell]]\nname = \"c\"\nrepetitions = 5\n");
  EXPECT_EQ(base, identity("[x]\n\n# text\nb = 2\na = 1\n[[cell]]\nrepetitions = 7\nname = \"c\"\n"));
  EXPECT_NE(base, identity("[x]\na = 1\nb = 3\n[[cell]]\nname = \"c\"\nrepetitions = 5\n"));
  EXPECT_NE(base, identity("[x]\na = 1\nb = 2\n[[cell]]\nname = \"d\"\nrepetitions = 5\n"));
}

TEST_F(TomlFile, PlanIndicesAndKeysAreInverse) {
  const auto spec = decode_campaign(*read(
      "[campaign]\nstudy = \"s\"\nseed = 1\n[[cell]]\nname = \"a\"\nrepetitions = 3\n[[cell]]\nname = \"b\"\n"
      "repetitions = 2\n"));
  ASSERT_TRUE(spec);
  ASSERT_EQ(spec->trial_count(), 5U);
  for (std::uint64_t i = 0; i < 5; ++i) EXPECT_EQ(spec->index(spec->key(i)), i);
  EXPECT_EQ(spec->key(3), (TrialKey{1, 0}));
}

}  // namespace
}  // namespace fatmc
