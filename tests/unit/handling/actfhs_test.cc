// The shipped truth model is what the shipped fit makes, and it has the published modes.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "core/handling/control_loop.h"
#include "core/handling/modes.h"
#include "tools/actfhs_problem.h"

namespace fatmc::fit {
namespace {

const ValueFit& shipped_fit() {
  static const ValueFit fit = solve(actfhs_problem());
  return fit;
}

TEST(ActFhs, RunAgainGivesTheShippedModelFile) {
  const ValueFit& fit = shipped_fit();
  ASSERT_TRUE(fit.converged);
  EXPECT_LT(fit.violation, 1e-6);
  std::ifstream in("campaigns/models/actfhs_60kt.toml");
  std::stringstream shipped;
  shipped << in.rdbuf();
  EXPECT_EQ(actfhs_toml(fit), shipped.str());
}

TEST(ActFhs, FittedDerivativesHaveThePhysicalSigns) {
  const ValueProblem problem = actfhs_problem();
  const ValueFit& fit = shipped_fit();
  const auto value = [&](const std::string& name) {
    for (std::size_t i = 0; i < problem.priors.size(); ++i) {
      if (problem.priors[i].name == name) return fit.values[static_cast<Eigen::Index>(i)];
    }
    ADD_FAILURE() << name;
    return 0.0;
  };
  for (const char* damping : {"X_u", "Z_w", "Y_v", "M_q", "N_r"}) EXPECT_LT(value(damping), 0.0) << damping;
  EXPECT_LT(value("L_v"), 0.0);  // dihedral effect
  EXPECT_GT(value("N_v"), 0.0);  // weathercock stability
  EXPECT_GT(value("M_a"), 0.0);  // the tilted disc pulls the fuselage after it
  EXPECT_GT(value("L_b"), 0.0);
  EXPECT_GT(value("tau"), 0.0);
  EXPECT_GT(value("damping"), 0.0);
}

/// The oscillation with the largest share of a response.
Mode leading_oscillation(const ContinuousModel& model, Eigen::Index output, Eigen::Index input) {
  const auto shares = mode_shares(model, output, input);
  EXPECT_TRUE(shares.has_value());
  ModeShare best;
  for (const ModeShare& mode : *shares) {
    if (mode.mode.oscillatory() && mode.peak > best.peak) best = mode;
  }
  return best.mode;
}

// The Dutch roll with the SCAS has a similar period and damping. A fit to the nearest mode takes it for the phugoid.
TEST(ActFhs, ThePhugoidWithTheScasIsThatOfThePitchResponse) {
  const ContinuousModel bare = actfhs_model(shipped_fit().values);
  constexpr Eigen::Index pitch_rate = 4, longitudinal = 0, yaw_rate = 5, pedal = 2;
  const Mode phugoid = leading_oscillation(stabilized_vehicle(bare), pitch_rate, longitudinal);
  EXPECT_NEAR(phugoid.period_s(), 4.9, 1e-3);
  EXPECT_NEAR(phugoid.damping(), 0.4, 1e-4);
  const Mode dutch_roll = leading_oscillation(bare, yaw_rate, pedal);
  EXPECT_NEAR(dutch_roll.period_s(), 3.1, 0.1);
  EXPECT_NEAR(dutch_roll.damping(), 0.15, 0.02);
}

}  // namespace
}  // namespace fatmc::fit
