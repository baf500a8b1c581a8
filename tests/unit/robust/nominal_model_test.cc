#include "core/robust/nominal_model.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include "core/robust/held_sampling.h"
#include "tests/unit/robust/random_plant.h"

namespace fatmc {
namespace {

std::vector<std::complex<double>> sorted_poles(const Eigen::MatrixXd& a) {
  const Eigen::VectorXcd values = a.eigenvalues();
  std::vector<std::complex<double>> out(values.data(), values.data() + values.size());
  std::sort(out.begin(), out.end(), [](auto x, auto y) { return std::arg(x) < std::arg(y); });
  return out;
}

// Poles 1.02 exp(±0.3j), 1 (real), −1.5 and 0.8 exp(±1j) behind a random change of basis.
SampledModel unstable_model() {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(6, 6);
  const auto pair = [&a](Eigen::Index k, double r, double angle) {
    a.block(k, k, 2, 2) << r * std::cos(angle), r * std::sin(angle), -r * std::sin(angle), r * std::cos(angle);
  };
  pair(0, 1.02, 0.3);
  pair(2, 0.8, 1.0);
  a(4, 4) = 1.0;
  a(5, 5) = -1.5;
  RandomStream stream({6, 0, 0, 0}, "basis");
  const Eigen::MatrixXd basis = test::random_loop(6, 6, stream).x.real();
  SampledModel model;
  model.a = basis * a * basis.inverse();
  model.b = Eigen::MatrixXd::Ones(6, 1);
  model.c = Eigen::MatrixXd::Ones(1, 6);
  model.d = Eigen::MatrixXd::Zero(1, 1);
  return model;
}

TEST(StabiliseNominalModel, MovesOuterPolesOntoTheCircleAndKeepsTheirAngleAndAllOthers) {
  const auto out = stabilise(unstable_model());
  ASSERT_TRUE(out.has_value());
  EXPECT_EQ(out->moved_poles, 4);
  EXPECT_NEAR(out->largest_modulus, 1.5, 1e-10);
  const auto poles = sorted_poles(out->model.a);
  const double r = kStablePoleRadius;
  const std::vector<std::complex<double>> expected = {std::polar(0.8, -1.0), std::polar(r, -0.3), r,
                                                      std::polar(r, 0.3),    std::polar(0.8, 1.0), -r};
  double worst = 0.0;
  for (const auto& e : expected) {
    double nearest = 10.0;
    for (const auto& p : poles) nearest = std::min(nearest, std::abs(p - e));
    worst = std::max(worst, nearest);
  }
  EXPECT_LT(worst, 1e-9);
  for (const auto& p : poles) EXPECT_LT(std::abs(p), 1.0);
}

TEST(StabiliseNominalModel, LeavesAStableModelAsItIsBitForBit) {
  SampledModel model = unstable_model();
  model.a *= 0.5;
  const auto out = stabilise(model);
  ASSERT_TRUE(out.has_value());
  EXPECT_EQ(out->moved_poles, 0);
  EXPECT_EQ(out->model.a, model.a);
}

TEST(StabiliseNominalModel, GivesNothingForAMatrixThatIsNotFinite) {
  SampledModel model = unstable_model();
  model.a(0, 0) = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(stabilise(model).has_value());
}

TEST(HeldSampling, HasTheKnownFormsOfALagAndOfADoubleIntegrator) {
  const auto matrix = [](double value) { return Eigen::MatrixXd::Constant(1, 1, value); };
  const auto lag = sample_held({matrix(-2.0), matrix(3.0), matrix(1.0), matrix(0.5)}, 0.25);
  ASSERT_TRUE(lag);
  EXPECT_NEAR(lag->a(0, 0), std::exp(-0.5), 1e-15);
  EXPECT_NEAR(lag->b(0, 0), 1.5 * (1.0 - std::exp(-0.5)), 1e-15);
  EXPECT_EQ(lag->d(0, 0), 0.5);
  Eigen::MatrixXd a(2, 2), b(2, 1);
  a << 0.0, 1.0, 0.0, 0.0;
  b << 0.0, 1.0;
  const auto integrators =
      sample_held({a, b, Eigen::MatrixXd::Identity(2, 2), Eigen::MatrixXd::Zero(2, 1)}, 0.5);
  ASSERT_TRUE(integrators);
  EXPECT_NEAR(integrators->a(0, 1), 0.5, 1e-15);
  EXPECT_NEAR(integrators->b(0, 0), 0.125, 1e-15);
  EXPECT_NEAR(integrators->b(1, 0), 0.5, 1e-15);
  EXPECT_FALSE(sample_held({matrix(1e6), matrix(1.0), matrix(1.0), matrix(0.0)}, 1.0));
}

}  // namespace
}  // namespace fatmc
