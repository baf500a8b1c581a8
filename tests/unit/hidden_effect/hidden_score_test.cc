#include "campaigns/hidden_effect/hidden_score.h"

#include <gtest/gtest.h>

#include <map>

namespace fatmc::hidden_effect {
namespace {

Effect effect(const char* text) { return *parse_effect(text); }

FoundEffect found(const char* text, double low, double high) {
  FoundEffect out{effect(text), {}, 0.0};
  const EffectParameter& p = out.effect.kind().parameters.front();
  out.parameters.push_back({std::string(p.name), std::string(p.unit), out.effect.values.front(), low, high});
  return out;
}

Diagnosis answer(Verdict verdict, std::vector<FoundEffect> effects, std::vector<Effect> members = {}) {
  Diagnosis out;
  out.verdict = verdict;
  out.effects = std::move(effects);
  out.members = std::move(members);
  return out;
}

std::map<std::string, double> scored(const Drawn& drawn, const Diagnosis& diagnosis,
                                     const DeclaredClasses& classes = {}) {
  TrialRow row;
  write_key(drawn, row);
  write_answer(drawn, diagnosis, classes, row);
  return {row.metrics.begin(), row.metrics.end()};
}

const Drawn kDelay{{effect("transport_delay:delay_s=0.04")}, {}};

TEST(HiddenScore, ARightNameHasItsErrorOverTheDistanceFromNominalAndItsCoverage) {
  const auto row =
      scored(kDelay, answer(Verdict::named, {found("transport_delay:delay_s=0.041", 0.0405, 0.0415)}));
  EXPECT_EQ(row.at("right_1"), 1.0);
  EXPECT_EQ(row.at("class_holds"), 1.0);
  EXPECT_EQ(row.at("spurious_count"), 0.0);
  EXPECT_NEAR(row.at("parameter_error_1"), 0.025, 1e-12);
  EXPECT_EQ(row.at("covered_1"), 0.0) << "0.04 lies below the interval";
  EXPECT_EQ(row.at("truth_1"), 0.04);
  EXPECT_EQ(row.at("found_1"), 0.041);
}

TEST(HiddenScore, FactorsErrByLogarithmsAndLimitsByTheirRatio) {
  const Drawn factor{{effect("mass:factor=1.21")}, {}};
  const auto mass = scored(factor, answer(Verdict::named, {found("mass:factor=1.1", 1.0, 1.3)}));
  EXPECT_NEAR(mass.at("parameter_error_1"), 0.5, 1e-12) << "log 1.1 is half of log 1.21";
  const Drawn limit{{effect("rate_limit:surface=aileron,limit_deg_s=4")}, {}};
  const auto rate =
      scored(limit, answer(Verdict::named, {found("rate_limit:surface=aileron,limit_deg_s=4.4", 3.0, 5.0)}));
  EXPECT_NEAR(rate.at("parameter_error_1"), std::log(1.1), 1e-12);
}

TEST(HiddenScore, AnotherChoiceOfTheSameEffectIsAWrongName) {
  const Drawn roll{{effect("inertia:axis=roll,factor=1.2")}, {}};
  const auto row = scored(roll, answer(Verdict::named, {found("inertia:axis=yaw,factor=1.2", 1.1, 1.3)}));
  EXPECT_EQ(row.at("right_1"), 0.0);
  EXPECT_EQ(row.at("spurious_count"), 1.0);
  EXPECT_FALSE(row.contains("parameter_error_1"));
}

TEST(HiddenScore, NamesOfADeclaredClassCountAsOneByIdOrByName) {
  const Drawn yaw{{effect("cn_r:factor=0.8")}, {}};
  const Diagnosis other = answer(Verdict::named, {found("cy_beta:factor=0.7", 0.6, 0.8)});
  EXPECT_EQ(scored(yaw, other).at("right_1"), 0.0);
  EXPECT_EQ(scored(yaw, other, {{"cn_r", "cy_beta"}}).at("right_1"), 1.0);
  EXPECT_EQ(scored(yaw, other, {{"cn_r", "cy_beta"}}).at("spurious_count"), 0.0);
  EXPECT_EQ(scored(yaw, other, {{"cn_r", "cl_r"}, {"cy_beta", "cn_p"}}).at("right_1"), 0.0);
  const Drawn gain{{effect("loop_gain:axis=roll,factor=0.8")}, {}};
  const Diagnosis pitch =
      answer(Verdict::named, {found("control_effectiveness:axis=pitch,factor=0.8", 0.7, 0.9)});
  EXPECT_EQ(scored(gain, pitch, {{"loop_gain", "control_effectiveness:axis=roll"}}).at("right_1"), 0.0);
  EXPECT_EQ(scored(gain, pitch, {{"loop_gain:axis=roll", "control_effectiveness"}}).at("right_1"), 1.0);
}

TEST(HiddenScore, AClassThatWasNotDeclaredHoldsTheTruthButIsNoRightName) {
  const Drawn yaw{{effect("cn_r:factor=0.8")}, {}};
  const std::vector<Effect> members = {effect("cy_beta:factor=0.7"), effect("cn_r:factor=0.8")};
  const Diagnosis d = answer(Verdict::effect_class, {found("cy_beta:factor=0.7", 0.6, 0.8)}, members);
  const auto row = scored(yaw, d);
  EXPECT_EQ(row.at("class_holds"), 1.0);
  EXPECT_EQ(row.at("class_size"), 2.0);
  EXPECT_EQ(row.at("right_1"), 0.0);
  EXPECT_EQ(scored(yaw, d, {{"cn_r", "cy_beta"}}).at("right_1"), 1.0);
}

TEST(HiddenScore, UnknownNamesNothingEvenWithAPartialExplanation) {
  const auto row =
      scored(kDelay, answer(Verdict::unknown, {found("transport_delay:delay_s=0.04", 0.03, 0.05)}));
  EXPECT_EQ(row.at("named_count"), 0.0);
  EXPECT_EQ(row.at("right_1"), 0.0);
  EXPECT_FALSE(row.contains("covered_1"));
}

TEST(HiddenScore, NamingWhatTheModelHasWrongIsNotSpuriousAndADrawnSecondEffectIsScoredOnItsOwn) {
  const Drawn guard{{effect("transport_delay:delay_s=0.04")}, {effect("cl_p:factor=1.04")}};
  const Diagnosis both = answer(Verdict::named, {found("transport_delay:delay_s=0.04", 0.03, 0.05),
                                                 found("cl_p:factor=1.05", 1.0, 1.1)});
  EXPECT_EQ(scored(guard, both).at("spurious_count"), 0.0);
  const Drawn two{{effect("transport_delay:delay_s=0.04"), effect("cl_p:factor=0.8")}, {}};
  const auto row = scored(two, both);
  EXPECT_EQ(row.at("right_1"), 1.0);
  EXPECT_EQ(row.at("right_2"), 1.0);
  EXPECT_EQ(row.at("covered_2"), 0.0);
}

TEST(HiddenScore, SaysKeyAndAnswerInWords) {
  TrialRow row;
  const Drawn guard{{effect("transport_delay:delay_s=0.04")}, {effect("cl_p:factor=1.04")}};
  write_key(guard, row);
  write_answer(guard, answer(Verdict::named, {found("gyro_lag:time_constant_s=0.04", 0.03, 0.05)}), {}, row);
  EXPECT_EQ(row.detail,
            "hidden transport_delay:delay_s=0.04; model off by cl_p:factor=1.04; answer named "
            "gyro_lag:time_constant_s=0.04");
}

}  // namespace
}  // namespace fatmc::hidden_effect
