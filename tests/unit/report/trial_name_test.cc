#include "coordinator/cli/trial_name.h"

#include <gtest/gtest.h>

namespace fatmc::cli {
namespace {

CampaignSpec spec_of(const std::vector<std::string>& names) {
  CampaignSpec spec;
  for (const std::string& name : names) {
    Cell cell;
    cell.name = name;
    cell.repetitions = 5;
    spec.cells.push_back(std::move(cell));
  }
  return spec;
}

TEST(TrialName, ANumberSufficesWhereThereIsOneCell) {
  EXPECT_EQ(parse_trial(spec_of({"a"}), "17")->repetition, 17U);
  EXPECT_EQ(parse_trial(spec_of({"a", "b"}), "17").error().text(),
            "TRIAL: \"17\" leaves the cell open, write CELL/REPETITION, for instance \"a/17\"");
}

TEST(TrialName, TheLastSlashEndsTheCellsName) {
  const CampaignSpec spec = spec_of({"a", "b/c, x=1"});
  const auto key = parse_trial(spec, "b/c, x=1/3");
  ASSERT_TRUE(key) << key.error().text();
  EXPECT_EQ(*key, (TrialKey{1, 3}));
  EXPECT_EQ(trial_name(spec, *key), "b/c, x=1/3");
}

TEST(TrialName, WhatIsNoTrialIsSaid) {
  const CampaignSpec spec = spec_of({"a", "b"});
  for (const char* text : {"", "/", "a/", "a/-1", "a/1x", "a/99999999999999999999", "1099511627776"}) {
    EXPECT_FALSE(parse_trial(spec, text)) << text;
  }
  EXPECT_EQ(parse_trial(spec, "c/1").error().text(), "TRIAL: no cell \"c\", write one of: \"a\", \"b\"");
}

}  // namespace
}  // namespace fatmc::cli
