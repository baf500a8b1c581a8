#include "campaigns/base/precision_rule.h"

#include <cmath>

#include "tests/unit/campaigns_base/toml_text.h"

namespace fatmc {
namespace {

class PrecisionText : public TomlTextTest {
 protected:
  std::string error_of(const std::string& text) {
    const auto rule = decode_precision(read(text));
    return rule ? "no error" : rule.error().text().substr(path_.size() + 1);
  }
};

TEST_F(PrecisionText, BoundsChooseTheMethodThatNeedsNoLaw) {
  const auto rule = decode_precision(read("[stop]\nmetric = \"x\"\nhalf_width = 0.1\nbounds = [0, 2]\n"));
  ASSERT_TRUE(rule && *rule);
  EXPECT_EQ((*rule)->sequence.kind, ConfidenceSequenceOptions::Kind::bernstein);
  EXPECT_EQ((*rule)->sequence.high, 2.0);
  EXPECT_EQ((*rule)->half_width, 0.1);
  const auto watch = decode_precision(read("[watch]\nmetric = \"x\"\n"));
  ASSERT_TRUE(watch && *watch);
  EXPECT_EQ((*watch)->sequence.kind, ConfidenceSequenceOptions::Kind::normal);
  EXPECT_FALSE((*watch)->half_width);
  EXPECT_FALSE(*decode_precision(read("a = 1\n")));
}

TEST_F(PrecisionText, ATrialWithoutTheMetricIsLeftOutOrHasTheValueGivenForIt) {
  PrecisionRule rule;
  rule.metric = "x";
  TrialRow row;
  row.metrics = {{"y", 1.0}, {"x", 2.0}};
  EXPECT_EQ(rule.value(row), 2.0);
  row.metrics = {{"x", std::nan("")}};
  EXPECT_EQ(rule.value(row), std::nullopt);
  rule.missing = 0.0;
  EXPECT_EQ(rule.value(row), 0.0);
  rule.metric = "failed";
  EXPECT_EQ(rule.value(row), 0.0);
  row.outcome = "diverged";
  EXPECT_EQ(rule.value(row), 1.0);
}

TEST_F(PrecisionText, ErrorsNameLineKeyAndRemedy) {
  EXPECT_EQ(error_of("[stop]\nmetric = \"x\"\n"), "1: stop.half_width: is missing");
  EXPECT_EQ(error_of("[stop]\nmetric = \"x\"\nhalf_width = 0\n"),
            "3: stop.half_width: is 0, write the half-width that is wanted");
  EXPECT_EQ(error_of("[stop]\nmetric = \"x\"\nhalf_width = 1\nmethod = \"bernstein\"\n"),
            "4: stop.method: bernstein needs bounds, write bounds = [low, high] that no value leaves");
  EXPECT_EQ(error_of("[watch]\nmetric = \"x\"\nbounds = [1, 0]\n"),
            "3: watch.bounds: are not in order, write [low, high]");
  EXPECT_EQ(error_of("[watch]\nmetric = \"x\"\nhalf_width = 1\n").substr(0, 43),
            "3: watch.half_width: is not a known key, th");
}

}  // namespace
}  // namespace fatmc
