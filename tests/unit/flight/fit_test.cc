// The shipped model is what the shipped fit makes.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "core/flight/linear_model.h"
#include "tests/unit/flight/fat.h"
#include "tools/fat_problem.h"
#include "tools/fit_problem.h"
#include "tools/write_fat.h"

namespace fatmc::fit {
namespace {

TEST(Fit, RunAgainGivesTheShippedModelFile) {
  const Fit fit = solve(fat_problem());
  ASSERT_TRUE(fit.converged);
  std::ifstream in("campaigns/models/fat.toml");
  std::stringstream shipped;
  shipped << in.rdbuf();
  EXPECT_EQ(fat_toml(fit.aircraft), shipped.str());
}

TEST(Fit, DerivativesHaveThePhysicalSigns) {
  const Aircraft& a = fat();
  EXPECT_GT(a.lift.alpha, 0.0);
  EXPECT_LT(a.pitch.alpha, 0.0);  // statically stable
  EXPECT_LT(a.pitch.q, 0.0);
  EXPECT_LT(a.pitch.eta, 0.0);
  EXPECT_LT(a.side.beta, 0.0);
  EXPECT_LT(a.roll.beta, 0.0);  // dihedral effect
  EXPECT_LT(a.roll.p, 0.0);
  EXPECT_GT(a.roll.r, 0.0);
  EXPECT_LT(a.roll.xi, 0.0);
  EXPECT_GT(a.yaw.beta, 0.0);  // weathercock stability
  EXPECT_LT(a.yaw.p, 0.0);
  EXPECT_LT(a.yaw.r, 0.0);
  EXPECT_GT(a.yaw.xi, 0.0);  // adverse yaw
  EXPECT_LT(a.yaw.zeta, 0.0);
  EXPECT_TRUE(check(a));
}

TEST(Fit, ALinearProblemIsSolvedExactly) {
  // One target on one parameter, prior pulling the other way: x = (t/e^2 + m/s^2)/(1/e^2 + 1/s^2).
  Problem problem;
  problem.parameters.push_back({"mass", [](Aircraft& a) -> double& { return a.mass_kg; }, 10.0, 2.0});
  problem.targets.push_back({"mass", 13.0, 1.0});
  problem.model = [](const Aircraft& a) { return Eigen::VectorXd(Eigen::VectorXd::Constant(1, a.mass_kg)); };
  const Fit fit = solve(problem);
  EXPECT_TRUE(fit.converged);
  EXPECT_NEAR(fit.aircraft.mass_kg, (13.0 + 10.0 / 4.0) / (1.0 + 1.0 / 4.0), 1e-8);
}

TEST(Fit, AConstraintHoldsExactlyAndThePriorsChooseTheRest) {
  // mass * span = 2 nearest to (1, 1) in units of spreads: mass = span = sqrt(2) by symmetry.
  Problem problem;
  problem.parameters.push_back({"mass", [](Aircraft& a) -> double& { return a.mass_kg; }, 1.0, 1.0});
  problem.parameters.push_back({"span", [](Aircraft& a) -> double& { return a.span_m; }, 1.0, 1.0});
  problem.targets.push_back({"product", 2.0, 1e-3, true});
  problem.model = [](const Aircraft& a) {
    return Eigen::VectorXd(Eigen::VectorXd::Constant(1, a.mass_kg * a.span_m));
  };
  const Fit fit = solve(problem);
  EXPECT_TRUE(fit.converged);
  EXPECT_NEAR(fit.aircraft.mass_kg, std::sqrt(2.0), 1e-8);
  EXPECT_NEAR(fit.aircraft.span_m, std::sqrt(2.0), 1e-8);
}

}  // namespace
}  // namespace fatmc::fit
