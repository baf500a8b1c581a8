#include "core/flight/linear_model.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "campaigns/models/fat_published.h"
#include "core/flight/zeros.h"
#include "tests/unit/flight/fat.h"

namespace fatmc {
namespace {

using Complex = std::complex<double>;

Complex nearest(const std::vector<Complex>& values, Complex wanted) {
  return *std::min_element(values.begin(), values.end(), [&](const Complex& x, const Complex& y) {
    return std::abs(x - wanted) < std::abs(y - wanted);
  });
}

class FatLinear : public testing::Test {
 protected:
  const Trim trim_ = trim_level(fat());
  const LinearModel continuous_ = linearize(fat(), trim_);
};

TEST_F(FatLinear, TrimStandsStill) {
  ASSERT_TRUE(trim_.usable());
  EXPECT_LT(trim_.residual, 1e-10);
  EXPECT_LE(trim_.iterations, 10);
  EXPECT_NEAR(trim_.alpha_rad, 2.5 * kPi / 180.0, 1e-6);
  EXPECT_NEAR(trim_.eta_rad, 0.0, 1e-6);
}

TEST_F(FatLinear, ASpeedThatWingAndMotorCannotHoldIsReported) {
  Aircraft slow = fat();
  slow.speed_m_s = 12.5;
  EXPECT_EQ(trim_level(slow).outcome, Trim::Outcome::outside_model);
  Aircraft weak = fat();
  weak.propulsion.stall_torque_n_m = 1.0;
  EXPECT_EQ(trim_level(weak).outcome, Trim::Outcome::outside_model);
}

TEST_F(FatLinear, EveryPoleOfTableA5IsMet) {
  const std::vector<Complex> poles = continuous_.poles();
  ASSERT_EQ(poles.size(), 16U);
  for (const auto& entry : fat_published::kTableA5) {
    const Complex wanted = fat_published::continuous(entry);
    const double bar = entry.mode == "spiral" ? 1e-3 : 1e-4;
    EXPECT_LT(std::abs(nearest(poles, wanted) - wanted), bar * std::abs(wanted)) << entry.mode;
  }
}

TEST_F(FatLinear, TheZeroPairOfYawRateIsMet) {
  const double omega = 2.0 * kPi * 0.05;
  const Complex zero = nearest(continuous_.zeros(2, 2), Complex(0.0, omega));
  EXPECT_NEAR(std::abs(zero), omega, 0.01 * omega);
  EXPECT_NEAR(-zero.real() / std::abs(zero), 0.199, 0.01 * 0.199);
}

/// Central differences of `f` at trim, with respect to states, commands and gusts in turn.
template <typename F>
Eigen::MatrixXd central_differences(const F& f) {
  constexpr int n = kLinearStates + 9;
  Eigen::MatrixXd out(kLinearStates, n);
  for (int j = 0; j < n; ++j) {
    constexpr double h = 1e-5;
    const auto at = [&](double step) {
      std::array<double, n> variables{};
      variables[static_cast<std::size_t>(j)] = step;
      const auto value = f(variables);
      return Eigen::Map<const Eigen::Matrix<double, kLinearStates, 1>>(value.data()).eval();
    };
    out.col(j) = (at(h) - at(-h)) / (2.0 * h);
  }
  return out;
}

std::array<double, kLinearStates> step_map(const Trim& trim, const std::array<double, kLinearStates + 9>& at,
                                           double tick, int steps) {
  const FlightConstants k(fat());
  std::array<double, kLinearStates> x;
  std::copy_n(at.begin(), kLinearStates, x.begin());
  State<double> full = displaced(trim, x);
  const std::array<double, 3> command = {at[16], at[17], at[18]};
  Demand<double> demand = trim.demand;
  demand.surfaces = mix(k, command, trim.demand.surfaces);
  const Gust<double> gust{{at[19], at[20], at[21]}, {at[22], at[23], at[24]}};
  for (int i = 0; i < steps; ++i) rk4_step(k, demand, gust, tick / steps, full);
  return displacement(trim, full);
}

TEST_F(FatLinear, TheSampledMapIsTheDerivativeOfTheFlownStep) {
  for (const int steps : {1, 4}) {
    const LinearModel sampled = sample(fat(), trim_, 0.02, steps);
    const Eigen::MatrixXd numeric =
        central_differences([&](const auto& at) { return step_map(trim_, at, 0.02, steps); });
    Eigen::MatrixXd exact(kLinearStates, kLinearStates + 9);
    exact << sampled.a, sampled.b, sampled.e;
    EXPECT_LT((exact - numeric).cwiseAbs().maxCoeff(), 1e-8 * exact.cwiseAbs().maxCoeff());
  }
}

TEST_F(FatLinear, TheContinuousModelIsTheLimitOfTheStepMap) {
  // (x(h) - x(-h))/(2h) = dx/dt + O(h^2) applied to the derivative of the flow.
  const double h = 1e-4;
  const LinearModel ahead = sample(fat(), trim_, h, 1);
  const LinearModel behind = sample(fat(), trim_, -h, 1);
  const LinearStateMatrix a = (ahead.a - behind.a) / (2.0 * h);
  const LinearInputMatrix b = (ahead.b - behind.b) / (2.0 * h);
  EXPECT_LT((a - continuous_.a).cwiseAbs().maxCoeff(), 1e-4 * continuous_.a.cwiseAbs().maxCoeff());
  EXPECT_LT((b - continuous_.b).cwiseAbs().maxCoeff(), 1e-4 * continuous_.b.cwiseAbs().maxCoeff());
}

TEST_F(FatLinear, TheSampledMapIsTheRungeKuttaPolynomialOfTheContinuousModel) {
  // The derivative of a Runge-Kutta step at an equilibrium is 1 + hA + (hA)^2/2 + (hA)^3/6 + (hA)^4/24.
  const double h = 0.02;
  const LinearModel sampled = sample(fat(), trim_, h, 1);
  const LinearStateMatrix ha = h * continuous_.a;
  const LinearStateMatrix one = LinearStateMatrix::Identity();
  const LinearStateMatrix phi = one + ha * (one + ha / 2.0 * (one + ha / 3.0 * (one + ha / 4.0)));
  const LinearInputMatrix gamma =
      (one + ha / 2.0 * (one + ha / 3.0 * (one + ha / 4.0))) * (h * continuous_.b);
  EXPECT_LT((sampled.a - phi).cwiseAbs().maxCoeff(), 1e-11 * phi.cwiseAbs().maxCoeff());
  EXPECT_LT((sampled.b - gamma).cwiseAbs().maxCoeff(), 1e-11 * gamma.cwiseAbs().maxCoeff());
}

TEST_F(FatLinear, LongitudinalAndLateralMotionAreDecoupledInLevelFlight) {
  for (const int i : {0, 2, 4, 7, 8}) {
    for (const int j : {1, 3, 5, 6}) {
      EXPECT_EQ(continuous_.a(i, j), 0.0) << i << " " << j;
      EXPECT_EQ(continuous_.a(j, i), 0.0) << j << " " << i;
    }
  }
}

TEST_F(FatLinear, APositiveCommandGivesAPositiveRateOfItsAxis) {
  const LinearModel sampled = sample(fat(), trim_, 0.02, 1);
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Matrix<double, kLinearStates, 1> x = Eigen::Matrix<double, kLinearStates, 1>::Zero();
    for (int i = 0; i < 15; ++i) x = sampled.a * x + sampled.b.col(axis) * 0.01;
    EXPECT_GT((sampled.c * x)[axis], 0.0) << axis;
  }
}

TEST(Zeros, OfAKnownTransferFunctionAreFound) {
  // (s^2 + 0.4 s + 4)/((s + 1)(s + 2)(s + 3)(s + 5)) in controller form, and a mode that the input does not
  // reach.
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(5, 5);
  a.topLeftCorner(4, 4) << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -30, -61, -41, -11;
  a(4, 4) = -7.0;
  const Eigen::VectorXd b = (Eigen::VectorXd(5) << 0, 0, 0, 1, 0).finished();
  const Eigen::RowVectorXd c = (Eigen::RowVectorXd(5) << 4, 0.4, 1, 0, 2.5).finished();
  const std::vector<Complex> zeros = transmission_zeros(a, b, c, 0.0);
  ASSERT_EQ(zeros.size(), 2U);
  EXPECT_LT(std::abs(zeros[0] - Complex(-0.2, std::sqrt(3.96))), 1e-10);
  EXPECT_LT(std::abs(zeros[1] - Complex(-0.2, -std::sqrt(3.96))), 1e-10);
}

TEST(Zeros, WithFeedthroughAreAsManyAsPoles) {
  // (s + 4)/(s + 1) = 1 + 3/(s + 1)
  const auto one = [](double v) { return Eigen::MatrixXd::Constant(1, 1, v); };
  const std::vector<Complex> zeros = transmission_zeros(one(-1.0), one(1.0), one(3.0), 1.0);
  ASSERT_EQ(zeros.size(), 1U);
  EXPECT_NEAR(zeros[0].real(), -4.0, 1e-12);
}

TEST_F(FatLinear, TheResponseVanishesAtAZero) {
  // q/eta_c has a zero at s = 0: a constant command ends in a constant attitude.
  EXPECT_LT(std::abs(continuous_.response(0.0)(1, 1)), 1e-9);
}

}  // namespace
}  // namespace fatmc
