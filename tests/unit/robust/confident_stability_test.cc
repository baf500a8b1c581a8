#include "core/robust/confident_stability.h"

#include <gtest/gtest.h>

#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "core/robust/loop_matrix.h"
#include "tests/unit/robust/random_plant.h"

namespace fatmc {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

EstimatedLine example_line() {
  RandomStream stream({4, 0, 0, 0}, "line");
  EstimatedLine line;
  line.response = test::random_loop(3, 3, stream).x.transpose();
  line.sigma = 0.02 * test::random_loop(3, 3, stream, 0.3).radii;
  line.bias = 0.01 * test::random_loop(3, 3, stream, 0.3).radii;
  line.degrees_of_freedom = 10.0;
  line.input_snr_db = 30.0;
  return line;
}

const Eigen::MatrixXcd kController = 0.1 * Eigen::MatrixXcd::Identity(3, 3);

TEST(ElementConfidence, WithoutBiasIsTheFDistributionOfKappaSquared) {
  for (const double q : {1.0, 4.5, 10.0, 60.0}) {
    const boost::math::fisher_f f(2.0, 2.0 * q);
    for (const double kappa : {0.01, 0.5, 1.0, 2.3, 7.0}) {
      EXPECT_NEAR(element_confidence(kappa, 0.37, 0.0, q), boost::math::cdf(f, kappa * kappa), 1e-14);
    }
  }
}

TEST(ElementConfidence, WithBiasIsTheLevelWhoseRegionHasTheToleratedSize) {
  const double q = 10.0, sigma = 0.3, bias = 0.2;
  const boost::math::fisher_f f(2.0, 2.0 * q);
  for (const double kappa : {0.41, 0.7, 1.0, 2.0, 5.0}) {
    const double p = element_confidence(kappa, sigma, bias, q);
    const double radius = std::sqrt(boost::math::quantile(f, p)) * sigma + bias;  // (2.269)
    EXPECT_NEAR(radius, kappa * (bias + sigma), 1e-9);
  }
}

TEST(ElementConfidence, IsZeroWhereTheBiasAloneFillsTheToleratedRegion) {
  // κ (b + σ) = b at κ = 0.4. The bare square of (2.271) would give 0.93 at κ = 0.
  EXPECT_EQ(element_confidence(0.4, 0.3, 0.2, 10.0), 0.0);
  EXPECT_EQ(element_confidence(0.1, 0.3, 0.2, 10.0), 0.0);
  EXPECT_EQ(element_confidence(0.0, 0.3, 0.2, 10.0), 0.0);
  EXPECT_GT(element_confidence(0.41, 0.3, 0.2, 10.0), 0.0);
}

TEST(ElementConfidence, HasALimitAtEveryEnd) {
  EXPECT_EQ(element_confidence(kInfinity, 0.3, 0.2, 10.0), 1.0);
  EXPECT_EQ(element_confidence(0.5, 0.0, 0.0, 10.0), 1.0);        // known exactly
  EXPECT_EQ(element_confidence(kInfinity, 0.0, 0.0, 10.0), 1.0);
  EXPECT_EQ(element_confidence(1.1, 0.0, 0.2, 10.0), 1.0);        // inside for certain
  EXPECT_EQ(element_confidence(0.9, 0.0, 0.2, 10.0), 0.0);
}

TEST(LineConfidence, OneSigmaHoldsAboutTheShareThatTheThesisStates) {
  // "about 63 %" for a known variance (1 − 1/e); 1 − (1 + 1/q)^(−q) tends to it.
  const Eigen::MatrixXd sigma = Eigen::MatrixXd::Ones(3, 3), none = Eigen::MatrixXd::Zero(3, 3);
  EXPECT_NEAR(line_confidence(1.0, sigma, none, 1e7, CombinationRule::min), 1.0 - std::exp(-1.0), 1e-6);
  EXPECT_NEAR(line_confidence(1.0, sigma, none, 10.0, CombinationRule::min), 1.0 - std::pow(1.1, -10.0), 1e-14);
}

TEST(LineConfidence, BonferroniInvertsItsOwnLevelForEqualElements) {
  const Eigen::MatrixXd sigma = Eigen::MatrixXd::Ones(3, 3), none = Eigen::MatrixXd::Zero(3, 3);
  const boost::math::fisher_f f(2.0, 20.0);
  const double level = 0.95, kappa = std::sqrt(boost::math::quantile(f, 1.0 - (1.0 - level) / 9.0));
  EXPECT_NEAR(line_confidence(kappa, sigma, none, 10.0, CombinationRule::bonferroni), level, 1e-12);
  EXPECT_EQ(line_confidence(0.5, sigma, none, 10.0, CombinationRule::bonferroni), 0.0);
}

TEST(LineConfidence, TheRulesAreOrderedAndTheWorstElementDecidesTheFirst) {
  const EstimatedLine line = example_line();
  const Eigen::MatrixXd systematic = systematic_error(line, {});
  for (const double kappa : {1.2, 2.0, 4.0}) {
    double least = 1.0;
    for (Eigen::Index k = 0; k < 9; ++k) {
      least = std::min(least, element_confidence(kappa, line.sigma(k), systematic(k), 10.0));
    }
    const double p = line_confidence(kappa, line.sigma, systematic, 10.0, CombinationRule::min);
    EXPECT_EQ(p, least);
    EXPECT_LE(line_confidence(kappa, line.sigma, systematic, 10.0, CombinationRule::bonferroni), p);
  }
}

TEST(LineConfidence, BonferroniIsBelowTheJointShareOfSimulatedEstimates) {
  // Nine independent elements with sample variances from q complex degrees of freedom each: the share of draws with all
  // inside κσ̂ lies above the bound, and for independent elements at the product of the nine levels.
  const double q = 10.0, kappa = 2.2;
  RandomStream stream({5, 0, 0, 0}, "joint");
  const int draws = 20000;
  int inside = 0;
  for (int n = 0; n < draws; ++n) {
    bool all = true;
    for (int element = 0; element < 9; ++element) {
      double variance = 0.0;
      for (int k = 0; k < 20; ++k) variance += std::pow(stream.normal(), 2) / 20.0;
      const double re = stream.normal(), im = stream.normal();
      all = all && 0.5 * (re * re + im * im) < kappa * kappa * variance;
    }
    inside += all ? 1 : 0;
  }
  const Eigen::MatrixXd sigma = Eigen::MatrixXd::Ones(3, 3), none = Eigen::MatrixXd::Zero(3, 3);
  const double single = line_confidence(kappa, sigma, none, q, CombinationRule::min);
  const double bound = line_confidence(kappa, sigma, none, q, CombinationRule::bonferroni);
  const double share = static_cast<double>(inside) / draws, joint = std::pow(single, 9);
  EXPECT_NEAR(share, joint, 4.0 * std::sqrt(joint * (1.0 - joint) / draws));
  EXPECT_LE(bound, joint);
}

TEST(JudgeLine, KappaTimesTheRadiiIsTheBorderOfTheCriterion) {
  const EstimatedLine line = example_line();
  const LineStability out = judge_line(line, line.response, kController);
  ASSERT_EQ(out.status, JudgementStatus::ok);
  const Eigen::MatrixXd radii = line.sigma + systematic_error(line, {});
  const LoopMatrix loop = loop_matrix(line.response, kController);
  EXPECT_NEAR(h_infinity_value(loop.x, out.kappa_h_infinity * radii), 1.0, 1e-12);
  EXPECT_NEAR(structured_singular_value(loop.x, out.kappa_ssv * radii).upper, 1.0, 1e-8);
  EXPECT_GE(out.kappa_ssv, out.kappa_h_infinity);
  EXPECT_GE(out.p_ssv, out.p_h_infinity);
}

TEST(JudgeLine, ANominalModelEqualToTheEstimateIsStableWithoutNaN) {
  const EstimatedLine line = example_line();
  const LineStability out = judge_line(line, line.response, kController);
  EXPECT_EQ(out.h_infinity_nominal, 0.0);
  EXPECT_EQ(out.ssv_nominal, 0.0);
  EXPECT_EQ(out.p_total_ssv, out.p_ssv);
}

TEST(JudgeLine, TotalConfidenceIsZeroForANominallyUnstableEstimateAndForALowSnr) {
  EstimatedLine line = example_line();
  const Eigen::MatrixXcd far = line.response + Eigen::MatrixXcd::Constant(3, 3, 40.0);
  const LineStability unstable = judge_line(line, far, kController);
  EXPECT_GT(unstable.h_infinity_nominal, 1.0);
  EXPECT_GT(unstable.p_h_infinity, 0.0);
  EXPECT_EQ(unstable.p_total_h_infinity, 0.0);
  line.input_snr_db = 19.9;
  const LineStability quiet = judge_line(line, line.response, kController);
  EXPECT_GT(quiet.p_ssv, 0.0);
  EXPECT_EQ(quiet.p_total_ssv, 0.0);
  line.input_snr_db = 20.0;
  EXPECT_GT(judge_line(line, line.response, kController).p_total_ssv, 0.0);
}

TEST(JudgeLine, BiasAndIntergridErrorOnlyLowerTheConfidence) {
  EstimatedLine line = example_line();
  line.sigma *= 10.0;
  line.bias *= 10.0;
  const Eigen::MatrixXcd controller = 3.0 * kController;
  const auto p = [&](bool bias, double intergrid) {
    StabilityOptions options;
    options.bias = bias;
    options.intergrid = intergrid;
    return judge_line(line, line.response, controller, options).p_ssv;
  };
  EXPECT_LT(p(true, 0.03), p(false, 0.03));
  EXPECT_LT(p(false, 0.03), p(false, 0.0));
}

TEST(JudgeLine, WhatCannotBeJudgedIsAnOutcomeWithAReason) {
  EstimatedLine line = example_line();
  const Eigen::MatrixXcd nominal = line.response;
  line.response(1, 1) = std::numeric_limits<double>::quiet_NaN();
  const LineStability nan = judge_line(line, nominal, kController);
  EXPECT_EQ(nan.status, JudgementStatus::not_finite);
  EXPECT_EQ(nan.p_total_ssv, 0.0);
  EXPECT_FALSE(std::isnan(nan.h_infinity) || std::isnan(nan.kappa_ssv));
  line.response = nominal;
  const Eigen::MatrixXcd opposite = -nominal.inverse();
  EXPECT_EQ(judge_line(line, nominal, opposite).status, JudgementStatus::singular_loop);
  EXPECT_EQ(judge_line(line, nominal, Eigen::MatrixXcd::Identity(2, 3)).status, JudgementStatus::wrong_shape);
  line.degrees_of_freedom = 0.0;
  EXPECT_EQ(judge_line(line, nominal, kController).status, JudgementStatus::wrong_shape);
}

TEST(CombineLines, MultipliesLinesAndKeepsTheGates) {
  const EstimatedLine line = example_line();
  std::vector<LineStability> lines(3, judge_line(line, line.response, 2.0 * kController));
  BandStability band = combine_lines(lines);
  EXPECT_NEAR(band.p_ssv, std::pow(lines[0].p_ssv, 3), 1e-15);
  EXPECT_EQ(band.p_total_ssv, band.p_ssv);
  EXPECT_TRUE(band.nominally_stable_ssv);
  EstimatedLine quiet = line;
  quiet.input_snr_db = 3.0;
  lines.push_back(judge_line(quiet, line.response, 2.0 * kController));
  band = combine_lines(lines);
  EXPECT_EQ(band.p_total_ssv, 0.0);
  EXPECT_EQ(band.low_snr_lines, 1);
  EXPECT_GT(band.p_ssv, 0.0);
}

}  // namespace
}  // namespace fatmc
