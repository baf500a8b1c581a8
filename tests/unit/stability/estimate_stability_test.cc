#include "core/stability/estimate_stability.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/random/random_stream.h"
#include "core/robust/intergrid.h"
#include "core/stats/confidence.h"

namespace fatmc {
namespace {

SampledModel two_by_two() {
  SampledModel m;
  m.a.resize(2, 2);
  m.a << 0.9, 0.1, -0.2, 0.8;
  m.b.resize(2, 2);
  m.b << 0.3, 0.05, -0.1, 0.4;
  m.c = Eigen::MatrixXd::Identity(2, 2);
  m.d = Eigen::MatrixXd::Zero(2, 2);
  return m;
}

const std::vector<double> kFrequencies{0.5, 0.6, 0.8, 1.2};
constexpr double kRate = 50.0;
constexpr int kQ = 10;

/// An estimate that is the model times `factor` with deviations of `relative` of the largest element.
FrmEstimate estimate_of(const SampledModel& model, double factor, double relative) {
  FrmEstimate e;
  e.n_out = e.n_in = 2;
  e.q = kQ;
  e.frequency_hz = kFrequencies;
  e.lines = {5, 6, 8, 12};
  const int count = e.line_count();
  e.G.resize(2, 2, count);
  e.B.resize(2, 2, count);
  e.C_V.resize(2, 2, count);
  e.input_snr.resize(2, 1, count);
  e.status.assign(4, LineStatus::ok);
  for (int k = 0; k < count; ++k) {
    e.G[k] = factor * sampled_response(model, kFrequencies[static_cast<std::size_t>(k)], kRate);
    const double sigma = relative * e.G[k].cwiseAbs().maxCoeff();
    e.B[k] = Eigen::Matrix2cd::Identity();
    e.C_V[k] = sigma * sigma * Eigen::Matrix2cd::Identity();
    e.input_snr[k].setConstant(100.0);
  }
  return e;
}

class EstimateStabilityTest : public ::testing::Test {
 protected:
  const SampledModel model = two_by_two();
  const Eigen::Matrix2d gain = 0.4 * Eigen::Matrix2d::Identity();
  const NominalLoop nominal = nominal_loop(model, gain, kFrequencies, kRate);
  const MatrixStack<double> no_bias{2, 2, 4};
  const StabilityOptions bare{.bias = false, .intergrid = 0.0};
};

TEST_F(EstimateStabilityTest, AnEstimateEqualToTheModelIsNominallyStableWithValueZero) {
  const EstimateStability out = judge_estimate(estimate_of(model, 1.0, 0.01), no_bias, nominal, bare);
  for (const LineStability& line : out.lines) {
    EXPECT_EQ(line.status, JudgementStatus::ok);
    EXPECT_LT(line.h_infinity_nominal, 1e-14);
    EXPECT_LT(line.ssv_nominal, 1e-14);
    EXPECT_LE(line.ssv.upper, line.h_infinity * (1.0 + 1e-12));
  }
  EXPECT_TRUE(out.band.nominally_stable_ssv);
  EXPECT_GT(out.band.p_total_ssv, 0.999);
}

// With one deviation for all elements and nothing systematic, p depends on κ alone: 1 − (1 + κ²/q)^−q.
TEST_F(EstimateStabilityTest, ConfidenceOfALineAndOfTheBandFollowFromKappa) {
  const EstimateStability out = judge_estimate(estimate_of(model, 1.1, 0.5), no_bias, nominal, bare);
  double band = 1.0;
  for (const LineStability& line : out.lines) {
    const double p = confidence_of_radius(1.0 / line.h_infinity, kQ);
    EXPECT_NEAR(line.p_h_infinity, p, 1e-12);
    EXPECT_LT(p, 1.0);
    band *= p;
  }
  EXPECT_NEAR(out.band.p_h_infinity, band, 1e-12);
}

TEST_F(EstimateStabilityTest, EveryLineIsTheLineJudgedAlone) {
  const FrmEstimate e = estimate_of(model, 1.2, 0.3);
  MatrixStack<double> bias(2, 2, 4);
  for (int k = 0; k < 4; ++k) bias[k].setConstant(0.01 * (k + 1));
  EstimateScalings kept;
  const EstimateStability first = judge_estimate(e, bias, nominal, {}, &kept);
  ASSERT_EQ(kept.size(), 4U);
  const EstimateStability again = judge_estimate(e, bias, nominal, {}, &kept);
  for (int k = 0; k < 4; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const LineStability alone = judge_line(estimated_line(e, bias, k), nominal.response[k], nominal.controller);
    EXPECT_DOUBLE_EQ(first.lines[at].h_infinity, alone.h_infinity);
    EXPECT_NEAR(first.lines[at].ssv.upper / alone.ssv.upper, 1.0, 1e-8);
    EXPECT_NEAR(again.lines[at].ssv.upper / alone.ssv.upper, 1.0, 1e-8);
    EXPECT_NEAR(first.lines[at].ssv_nominal / alone.ssv_nominal, 1.0, 1e-8);
    EXPECT_NEAR(first.snr_min_db[at], 40.0, 1e-12);
  }
}

TEST_F(EstimateStabilityTest, ALineWithoutAnEstimateHasNoConfidenceInsteadOfAllOfIt) {
  FrmEstimate e = estimate_of(model, 1.0, 0.01);
  e.status[2] = LineStatus::singular_regressor;
  e.G[2].setZero();
  e.C_V[2].setZero();
  const EstimateStability out = judge_estimate(e, no_bias, nominal, bare);
  EXPECT_EQ(out.lines[2].status, JudgementStatus::no_estimate);
  EXPECT_EQ(out.band.failed_lines, 1);
  EXPECT_EQ(out.band.p_ssv, 0.0);
  EXPECT_FALSE(out.band.nominally_stable_ssv);
}

TEST_F(EstimateStabilityTest, InputsInTheirNoiseCloseTheGate) {
  FrmEstimate e = estimate_of(model, 1.0, 0.01);
  e.input_snr[1](0, 0) = -0.5;  // |U^| below s
  e.input_snr[3](1, 0) = std::numeric_limits<double>::infinity();
  const EstimateStability out = judge_estimate(e, no_bias, nominal, bare);
  EXPECT_EQ(out.snr_min_db[1], -kSnrLimitDb);
  EXPECT_NEAR(out.snr_min_db[3], 40.0, 1e-12);  // of the other input
  EXPECT_EQ(out.band.low_snr_lines, 1);
  EXPECT_GT(out.band.p_ssv, 0.99);
  EXPECT_EQ(out.band.p_total_ssv, 0.0);
}

// 0.5·y[n−1] delayed: the loop z − 0.5 + 0.5 k has its pole at 0.5 − 0.5 k, and feed-through d divides k by 1 + k d.
TEST(SampledNominalModel, ClosedLoopPoleIsThatOfTheScalarLoop) {
  SampledModel m;
  m.a = m.b = Eigen::MatrixXd::Constant(1, 1, 0.5);
  m.c = Eigen::MatrixXd::Identity(1, 1);
  m.d = Eigen::MatrixXd::Zero(1, 1);
  const auto radius = [&m](double k) { return closed_loop_radius(m, Eigen::MatrixXd::Constant(1, 1, k)); };
  EXPECT_NEAR(*radius(2.0), 0.5, 1e-15);
  EXPECT_NEAR(*radius(5.0), 2.0, 1e-15);
  m.d(0, 0) = 2.0;
  EXPECT_NEAR(*radius(2.0), std::abs(0.5 - 0.5 * 2.0 / 5.0), 1e-15);
  EXPECT_FALSE(radius(-0.5).has_value());  // 1 + k d = 0
}

TEST(SampledNominalModel, ResponseIsTheTransferFunctionOnTheUnitCircle) {
  const SampledModel m = two_by_two();
  const std::complex<double> z = std::polar(1.0, 2.0 * 3.14159265358979323846 * 0.7 / kRate);
  // C = I: adj(zI − A) B / det.
  const std::complex<double> det = (z - 0.9) * (z - 0.8) + 0.02;
  Eigen::Matrix2cd adjugate;
  adjugate << z - 0.8, 0.1, -0.2, z - 0.9;
  EXPECT_LT((sampled_response(m, 0.7, kRate) - adjugate * m.b / det).norm(), 1e-13);
}

TEST(IntergridCover, TheGapThatIsWidestForItsFrequencyDecides) {
  const auto cover = intergrid_cover({1.0, 1.1, 3.0, 3.2}, 0.03);
  ASSERT_TRUE(cover);
  EXPECT_DOUBLE_EQ(cover->frequency_hz, 2.05);
  EXPECT_DOUBLE_EQ(cover->damping, covered_damping(1.9 / 2.05, 0.03));
  EXPECT_FALSE(intergrid_cover({1.0}, 0.03));
}

}  // namespace
}  // namespace fatmc
