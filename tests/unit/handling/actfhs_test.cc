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

}  // namespace
}  // namespace fatmc::fit
