#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/random/random_stream.h"
#include "core/signal/decimate.h"
#include "core/subspace/discrete_model.h"
#include "core/subspace/eigenvalues.h"
#include "core/subspace/model_fit.h"
#include "core/subspace/riccati.h"

namespace fatmc {
namespace {

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, std::uint64_t run) {
  RandomStream stream({5, 6, 7, run}, "matrix");
  Eigen::MatrixXd out(rows, columns);
  for (Eigen::Index j = 0; j < columns; ++j) {
    for (Eigen::Index i = 0; i < rows; ++i) out(i, j) = stream.normal();
  }
  return out;
}

/// A stable model of two pairs and a real mode.
DiscreteModel five_states() {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(5, 5);
  a.block(0, 0, 2, 2) << 0.9, 0.3, -0.3, 0.9;
  a.block(2, 2, 2, 2) << 0.5, 0.6, -0.6, 0.5;
  a(4, 4) = 0.99;
  const Eigen::MatrixXd basis = random_matrix(5, 5, 1);
  return {basis * a * basis.inverse(), random_matrix(5, 2, 2), random_matrix(3, 5, 3)};
}

Eigen::MatrixXd markov(const DiscreteModel& model, int lag) {
  Eigen::MatrixXd power = model.b;
  for (int i = 0; i < lag; ++i) power = model.a * power;
  return model.c * power;
}

void expect_same_response(const DiscreteModel& one, const DiscreteModel& other) {
  for (int lag = 0; lag < 12; ++lag) EXPECT_LT((markov(one, lag) - markov(other, lag)).norm(), 1e-10);
}

TEST(Riccati, ScalarEquationHasItsClosedFormSolution) {
  // p = a^2 p r / (p + r) + q with c = 1:  p^2 + p (r - a^2 r - q) - q r = 0.
  const double a = 0.8, q = 0.3, r = 0.5, half = 0.5 * (r - a * a * r - q);
  const double p = -half + std::sqrt(half * half + q * r);
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(1, 1);
  const auto gain = kalman_gain(a * one, one, {q * one, 0.0 * one, r * one});
  ASSERT_TRUE(gain.has_value());
  EXPECT_NEAR(gain->p(0, 0), p, 1e-14);
  EXPECT_NEAR(gain->k(0, 0), a * p / (p + r), 1e-14);
}

TEST(Riccati, WhereTheInnovationsAreTheNoiseTheGainIsTheirs) {
  // w = K e: Q = K R K^T, S = K R. Then P = 0 solves the equation and the gain is K.
  DiscreteModel model = five_states();
  model.a = modal_model(model)->model.a;  // well conditioned, so that a small K leaves it stable
  const Eigen::MatrixXd k = 0.01 * random_matrix(5, 3, 4), root = random_matrix(3, 3, 5);
  const Eigen::MatrixXd r = root * root.transpose();
  ASSERT_LT(*spectral_radius(model.a - k * model.c), 1.0);
  const auto gain = kalman_gain(model.a, model.c, {k * r * k.transpose(), k * r, r});
  ASSERT_TRUE(gain.has_value()) << gain.error().message;
  EXPECT_LT((gain->k - k).norm(), 1e-10);
}

TEST(Riccati, RandomProblemsAreSolvedToRoundOffWithAStablePredictor) {
  for (std::uint64_t run = 20; run < 40; ++run) {
    const Eigen::MatrixXd a = 0.5 * random_matrix(6, 6, run), c = random_matrix(2, 6, run),
                          w = random_matrix(8, 8, run + 100);
    const Eigen::MatrixXd joint = w * w.transpose();
    const auto gain = kalman_gain(
        a, c, {joint.topLeftCorner(6, 6), joint.topRightCorner(6, 2), joint.bottomRightCorner(2, 2)});
    ASSERT_TRUE(gain.has_value()) << gain.error().message;
    EXPECT_LT(gain->residual, 1e-10);
    EXPECT_LT(gain->predictor_radius, 1.0);
  }
}

TEST(Riccati, AnUnstableModeThatNoOutputSeesIsRefused) {
  const Eigen::MatrixXd a = Eigen::Vector2d(1.2, 0.5).asDiagonal(),
                        c = (Eigen::MatrixXd(1, 2) << 0.0, 1.0).finished();
  const Eigen::MatrixXd q = Eigen::MatrixXd::Identity(2, 2), s = Eigen::MatrixXd::Zero(2, 1),
                        r = Eigen::MatrixXd::Identity(1, 1);
  const auto gain = kalman_gain(a, c, {q, s, r});
  ASSERT_FALSE(gain.has_value());
  EXPECT_NE(gain.error().message.find("stabilising"), std::string::npos);
}

TEST(ContinuousModel, ZeroOrderHoldOfADampedModeAndBack) {
  // dx/dt = s x + b u sampled by hand: exp(s T), (exp(s T) - 1)/s b in real form.
  const double t = 0.04;
  const std::complex<double> s(-0.4, 2.0), z = std::exp(s * t), gamma = (z - 1.0) / s;
  DiscreteModel model;
  model.a = (Eigen::Matrix2d() << z.real(), z.imag(), -z.imag(), z.real()).finished();
  model.b = Eigen::Vector2d(gamma.real(), -gamma.imag());
  model.c = Eigen::RowVector2d(1.0, 0.0);
  const auto continuous = continuous_model(model, t, Continuation::zoh);
  ASSERT_TRUE(continuous.has_value());
  const Eigen::Matrix2d a = (Eigen::Matrix2d() << s.real(), s.imag(), -s.imag(), s.real()).finished();
  EXPECT_LT((continuous->a - a).norm(), 1e-12);
  EXPECT_LT((continuous->b - Eigen::Vector2d(1.0, 0.0)).norm(), 1e-12);
}

TEST(ContinuousModel, BilinearKeepsTheResponseAtWarpedFrequencies) {
  const DiscreteModel model = five_states();
  const double t = 0.1;
  const auto continuous = continuous_model(model, t, Continuation::bilinear);
  ASSERT_TRUE(continuous.has_value());
  for (const double f : {0.1, 0.7, 3.0}) {
    const std::complex<double> z = std::polar(1.0, 2.0 * std::numbers::pi * f * t),
                               s = 2.0 / t * (z - 1.0) / (z + 1.0);
    const Eigen::MatrixXcd eye = Eigen::MatrixXcd::Identity(5, 5);
    const Eigen::MatrixXcd discrete =
        model.c.cast<std::complex<double>>() * (z * eye - model.a).inverse() * model.b;
    const Eigen::MatrixXcd warped =
        continuous->c.cast<std::complex<double>>() * (s * eye - continuous->a).inverse() * continuous->b +
        continuous->d;
    EXPECT_LT((discrete - warped).norm(), 1e-10 * discrete.norm());
  }
}

TEST(ContinuousModel, AnEigenvalueOnTheNegativeAxisHasNoLogarithm) {
  DiscreteModel model{Eigen::Vector2d(-0.5, 0.8).asDiagonal(), Eigen::MatrixXd::Ones(2, 1),
                      Eigen::MatrixXd::Ones(1, 2)};
  const auto continuous = continuous_model(model, 1.0, Continuation::zoh);
  ASSERT_FALSE(continuous.has_value());
  EXPECT_NE(continuous.error().message.find("-0.5"), std::string::npos);
  EXPECT_TRUE(continuous_model(model, 1.0, Continuation::bilinear).has_value());
}

TEST(Bases, ModalFormKeepsTheResponseAndBeginsWithTheSlowestMode) {
  const DiscreteModel model = five_states();
  const auto modal = modal_model(model);
  ASSERT_TRUE(modal.has_value());
  expect_same_response(model, modal->model);
  EXPECT_NEAR(modal->eigenvalues(0).real(), 0.99, 1e-10);
  EXPECT_NEAR(std::abs(modal->eigenvalues(1)), std::hypot(0.9, 0.3), 1e-10);
  Eigen::MatrixXd off = modal->model.a;
  off(0, 0) = 0.0;
  off.block(1, 1, 2, 2).setZero();
  off.block(3, 3, 2, 2).setZero();
  EXPECT_LT(off.norm(), 1e-10);
}

TEST(Bases, OutputsBecomeTheFirstStates) {
  const DiscreteModel model = five_states();
  const auto moved = output_states_model(model);
  ASSERT_TRUE(moved.has_value());
  expect_same_response(model, *moved);
  EXPECT_LT((moved->c - Eigen::MatrixXd::Identity(3, 5)).norm(), 1e-12);
}

TEST(ModelFit, FindsStartAndOffsetOfAManeuverExactly) {
  const DiscreteModel model = five_states();
  const auto modal = modal_model(model);
  ASSERT_TRUE(modal.has_value());
  Maneuver maneuver{random_matrix(120, 2, 9), Eigen::MatrixXd(120, 3)};
  Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(5, 1.0, -2.0);
  const Eigen::VectorXd x0 = x;
  const Eigen::RowVector3d y0(0.3, -1.0, 2.0);
  for (Eigen::Index t = 0; t < 120; ++t) {
    maneuver.outputs.row(t) = (modal->model.c * x).transpose() + y0;
    x = (modal->model.a * x + modal->model.b * maneuver.inputs.row(t).transpose()).eval();
  }
  const auto fit = fit_maneuver(model, maneuver);
  ASSERT_TRUE(fit.has_value());
  EXPECT_LT((fit->x0 - x0).norm(), 1e-8);
  EXPECT_LT((fit->y0.transpose() - y0).norm(), 1e-8);
  EXPECT_LT(rms_error(maneuver.outputs, fit->outputs), 1e-10);
  EXPECT_NEAR(variance_accounted_for(maneuver.outputs.col(0), fit->outputs.col(0)), 100.0, 1e-9);
  // Four free states would cut the second pair in two: three stay.
  EXPECT_EQ(fit_maneuver(model, maneuver, 4)->x0.size(), 3);
}

TEST(ModelFit, RatingsAreThoseOfThePaper) {
  EXPECT_EQ(rms_rating(0.82), "excellent");
  EXPECT_EQ(rms_rating(1.77), "good");
  EXPECT_EQ(agreement_rating(0.95), "excellent");
  EXPECT_EQ(agreement_rating(0.91), "good");
  EXPECT_EQ(agreement_rating(0.79), "inadequate");
}

TEST(Decimate, KeepsSlowSinesInPlaceAndStopsFastOnes) {
  const int n = 2000, factor = 4;
  const auto sine = [&](double cycles_per_sample) {
    Eigen::MatrixXd out(n, 1);
    for (int i = 0; i < n; ++i) out(i, 0) = std::sin(2.0 * std::numbers::pi * cycles_per_sample * i);
    return out;
  };
  const Eigen::MatrixXd slow = sine(0.02), kept = decimate(slow, factor),
                        stopped = decimate(sine(0.3), factor);
  ASSERT_EQ(kept.rows(), 500);
  for (int i = 20; i < 480; ++i) {
    EXPECT_NEAR(kept(i, 0), slow(i * factor, 0), 3e-3);
    EXPECT_LT(std::abs(stopped(i, 0)), 3e-3);
  }
  EXPECT_EQ(decimate(slow, 1), slow);
}

}  // namespace
}  // namespace fatmc
