#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/handling/control_loop.h"
#include "core/handling/modes.h"
#include "core/handling/requirements.h"
#include "core/random/random_stream.h"

namespace fatmc {
namespace {

using Complex = std::complex<double>;

ContinuousModel some_model(bool with_direct_path) {
  RandomStream stream({1, 0, 0, 0}, "model");
  const auto draw = [&](Eigen::Index rows, Eigen::Index columns) {
    Eigen::MatrixXd out(rows, columns);
    for (Eigen::Index j = 0; j < columns; ++j) {
      for (Eigen::Index i = 0; i < rows; ++i) out(i, j) = stream.normal();
    }
    return out;
  };
  return {draw(5, 5) - 3.0 * Eigen::MatrixXd::Identity(5, 5), draw(5, 2), draw(3, 5),
          with_direct_path ? draw(3, 2) : Eigen::MatrixXd::Zero(3, 2)};
}

Eigen::MatrixXcd response(const ContinuousModel& model, Complex s) {
  const Eigen::Index n = model.a.rows();
  const Eigen::MatrixXcd resolvent = (s * Eigen::MatrixXcd::Identity(n, n) - model.a).inverse();
  return model.c * resolvent * model.b + model.d;
}

TEST(ControlLoop, FeedbackGivesTheClosedLoopResponse) {
  const Eigen::MatrixXd gain = 0.3 * Eigen::MatrixXd::Ones(2, 3);
  for (const bool direct : {false, true}) {
    const ContinuousModel model = some_model(direct), closed = with_feedback(model, gain);
    for (const double w : {0.0, 0.7, 4.0}) {
      const Eigen::MatrixXcd g = response(model, {0.0, w});
      const Eigen::MatrixXcd loop = Eigen::MatrixXcd::Identity(3, 3) + g * gain;
      EXPECT_LT((response(closed, {0.0, w}) - loop.inverse() * g).norm(), 1e-12);
    }
  }
}

TEST(ControlLoop, FilterMultipliesTheColumnOfItsInput) {
  const InputFilter filter{0.9, 0.4, -6.0, 0.6, 12.6};
  for (const bool direct : {false, true}) {
    const ContinuousModel model = some_model(direct), filtered = with_input_filter(model, 1, filter);
    for (const double w : {0.0, 3.0, 12.6, 40.0}) {
      const Complex s(0.0, w);
      const Complex factor =
          1.0 + 0.9 * (0.4 * s * s - 6.0 * s) / (s * s + 2.0 * 0.6 * 12.6 * s + 12.6 * 12.6);
      Eigen::MatrixXcd expected = response(model, s);
      expected.col(1) *= factor;
      EXPECT_LT((response(filtered, s) - expected).norm(), 1e-12);
    }
  }
}

TEST(ControlLoop, TheFilterActsOnFeedbackAndPilotAlike) {
  // H (15): the pilot's input and the feedback are summed before the filter.
  ContinuousModel model = some_model(false);
  model.b = Eigen::MatrixXd::Random(5, 4);
  model.c = Eigen::MatrixXd::Random(8, 5);
  model.d = Eigen::MatrixXd::Zero(8, 4);
  const Complex s(0.0, 5.0);
  const Complex factor = 1.0 + 0.9 * (0.4 * s * s - 6.0 * s) / (s * s + 2.0 * 0.6 * 12.6 * s + 12.6 * 12.6);
  Eigen::MatrixXcd g = response(model, s);
  g.col(1) *= factor;
  const Eigen::MatrixXcd loop = Eigen::MatrixXcd::Identity(8, 8) + g * act_fhs_gain();
  const Eigen::MatrixXcd expected = loop.inverse() * g;
  EXPECT_LT((response(optimized_vehicle(model), s) - expected).norm(), 1e-11 * expected.norm());
}

TEST(Modes, PeriodAndDampingOfAPairAreThoseItWasMadeOf) {
  for (const double damping : {-0.16, 0.03, 0.58}) {
    const Mode mode = mode_of(4.9, damping);
    EXPECT_NEAR(mode.period_s(), 4.9, 1e-12);
    EXPECT_NEAR(mode.damping(), damping, 1e-12);
  }
}

TEST(Modes, TheNearestIsFoundWithinItsBoundOnly) {
  const std::vector<Mode> modes = {mode_of(19.0, -0.1), mode_of(5.0, 0.3), {{-1.0, 0.0}}};
  EXPECT_NEAR(nearest_mode(modes, mode_of(4.9, 0.4), 0.3)->period_s(), 5.0, 1e-12);
  EXPECT_FALSE(nearest_mode(modes, mode_of(0.5, 0.1), 0.5).has_value());
}

TEST(Modes, APoleThatAZeroCancelsHasNoShare) {
  // Two oscillators side by side, the output sees the first alone.
  ContinuousModel model{Eigen::MatrixXd::Zero(4, 4), Eigen::MatrixXd::Ones(4, 1), Eigen::MatrixXd::Zero(1, 4),
                        Eigen::MatrixXd::Zero(1, 1)};
  model.a.topLeftCorner(2, 2) << -0.1, 2.0, -2.0, -0.1;
  model.a.bottomRightCorner(2, 2) << -0.2, 5.0, -5.0, -0.2;
  model.c(0, 0) = 1.0;
  const auto shares = mode_shares(model, 0, 0);
  ASSERT_TRUE(shares.has_value());
  ASSERT_EQ(shares->size(), 2U);
  EXPECT_NEAR((*shares)[0].share, 1.0, 1e-12);
  EXPECT_NEAR((*shares)[1].share, 0.0, 1e-12);
  // |residue| of 1/2 (1 - j) e^(st) and its conjugate is sqrt(1/2), over |Re s| = 0.1.
  EXPECT_NEAR((*shares)[0].peak, std::sqrt(0.5) / 0.1, 1e-10);
}

TEST(Requirements, ThePublishedModesAreJudgedAsThePaperDoes) {
  const Mode bare = mode_of(19.2, -0.16), stabilized = mode_of(4.9, 0.4);
  EXPECT_FALSE(meets_cs27(bare, PilotCrew::single));
  EXPECT_TRUE(meets_cs27(bare, PilotCrew::two));
  EXPECT_NEAR(std::numbers::ln2 / bare.s.real(), 13.0, 0.1);  // doubles in 13 s
  EXPECT_TRUE(meets_cs27(stabilized, PilotCrew::single));
  EXPECT_EQ(ads33_level(bare), 2);
  EXPECT_EQ(ads33_level(stabilized), 1);
  EXPECT_EQ(ads33_level(mode_of(0.55, 0.03)), 2);
  EXPECT_EQ(ads33_level(mode_of(0.43, 0.58)), 1);
}

TEST(Requirements, AResponseIsAsGoodAsItsWorstVisibleMode) {
  const std::vector<ModeShare> modes = {{mode_of(4.9, 0.4), 1.0, 1.0}, {mode_of(0.55, 0.03), 0.02, 0.02}};
  EXPECT_EQ(ads33_level(modes, 0.05), 1);
  EXPECT_EQ(ads33_level(modes, 0.01), 2);
  EXPECT_EQ(cs27_approval(modes, 0.05), Approval::single_pilot);
  EXPECT_EQ(cs27_approval(modes, 0.01), Approval::none);  // 0.83 of the amplitude is left after one cycle
}

TEST(Requirements, BoundariesOfCs27) {
  const double half = std::numbers::ln2 / (2.0 * std::numbers::pi);  // D / sqrt(1 - D^2) of one cycle to half
  const auto damping = [&](double cycles) { return half / cycles / std::hypot(1.0, half / cycles); };
  EXPECT_TRUE(meets_cs27(mode_of(4.0, 1.001 * damping(1.0)), PilotCrew::single));
  EXPECT_FALSE(meets_cs27(mode_of(4.0, 0.999 * damping(1.0)), PilotCrew::single));
  EXPECT_TRUE(meets_cs27(mode_of(7.0, 1.001 * damping(2.0)), PilotCrew::single));
  EXPECT_FALSE(meets_cs27(mode_of(7.0, 0.999 * damping(2.0)), PilotCrew::single));
  EXPECT_FALSE(meets_cs27(mode_of(7.0, -0.001), PilotCrew::two));
  EXPECT_TRUE(meets_cs27(mode_of(7.0, 0.001), PilotCrew::two));
}

TEST(ImpulseResponse, OfASecondOrderSystemIsTheDampedSine) {
  // 1 / (s^2 + 2 D w s + w^2): e^(-D w t) sin(w_d t) / w_d
  const double w = 3.0, d = 0.2, damped = w * std::sqrt(1.0 - d * d);
  ContinuousModel model;
  model.a.resize(2, 2);
  model.a << 0.0, 1.0, -w * w, -2.0 * d * w;
  model.b = Eigen::Vector2d(0.0, 1.0);
  model.c = Eigen::RowVector2d(1.0, 0.0);
  model.d = Eigen::MatrixXd::Zero(1, 1);
  const std::vector<double> times = {0.0, 0.3, 1.7};
  const auto response = impulse_response(model, 0, 0, times);
  ASSERT_TRUE(response.has_value());
  for (std::size_t i = 0; i < times.size(); ++i)
    EXPECT_NEAR((*response)[i], std::exp(-d * w * times[i]) * std::sin(damped * times[i]) / damped, 1e-14);
}

TEST(ImpulseResponse, AgreesWithARungeKuttaIntegration) {
  const ContinuousModel model = some_model(false);
  const std::vector<double> times = {0.5};
  const auto response = impulse_response(model, 1, 1, times);
  ASSERT_TRUE(response.has_value());
  Eigen::VectorXd x = model.b.col(1);
  const double h = 1e-3;
  for (int k = 0; k < 500; ++k) {
    const Eigen::VectorXd k1 = model.a * x, k2 = model.a * (x + 0.5 * h * k1),
                          k3 = model.a * (x + 0.5 * h * k2), k4 = model.a * (x + h * k3);
    x += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  EXPECT_NEAR(response->front(), (model.c * x)(1), 1e-9);
}

}  // namespace
}  // namespace fatmc
