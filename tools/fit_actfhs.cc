// Fits a linear helicopter to the modes that H prints of the ACT/FHS and writes campaigns/models/actfhs_60kt.toml.
// Usage: fit_actfhs > campaigns/models/actfhs_60kt.toml
// What was reached, parameter by parameter, and all modes of the three vehicles go to standard error.
#include <cstdio>

#include "core/handling/control_loop.h"
#include "core/handling/modes.h"
#include "tools/actfhs_problem.h"

namespace fatmc::fit {
namespace {

void print_modes(const char* title, const ContinuousModel& model) {
  std::fprintf(stderr, "%s\n", title);
  const auto modes = modes_of(model.a);
  if (!modes) return;
  for (const Mode& mode : *modes) {
    if (mode.oscillatory()) {
      std::fprintf(stderr, "  %9.4f %+9.4fj   T %7.3f s   D %6.3f\n", mode.s.real(), mode.s.imag(),
                   mode.period_s(), mode.damping());
    } else {
      std::fprintf(stderr, "  %9.4f\n", mode.s.real());
    }
  }
}

int run() {
  const ValueProblem setup = actfhs_problem();
  const ValueFit fit = solve(setup);
  std::fprintf(stderr, "%s after %d iterations, last step %.2g, violation %.2g\n",
               fit.converged ? "converged" : "not converged", fit.iterations, fit.step, fit.violation);
  for (std::size_t i = 0; i < setup.targets.size(); ++i) {
    std::fprintf(stderr, "%-20s wanted %12.8g reached %12.8g\n", setup.targets[i].name.c_str(),
                 setup.targets[i].value, fit.reached[static_cast<Eigen::Index>(i)]);
  }
  for (std::size_t i = 0; i < setup.priors.size(); ++i) {
    const Prior& p = setup.priors[i];
    const double value = fit.values[static_cast<Eigen::Index>(i)];
    std::fprintf(stderr, "%-8s prior %9.5g +- %-8.3g fitted %12.7g (%+.2f)\n", p.name.c_str(), p.value,
                 p.spread, value, (value - p.value) / p.spread);
  }
  const ContinuousModel bare = actfhs_model(fit.values);
  print_modes("bare", bare);
  print_modes("with the SCAS (14)", stabilized_vehicle(bare));
  print_modes("with SCAS and filter (15)", optimized_vehicle(bare));
  if (!fit.converged) return 1;
  std::fputs(actfhs_toml(fit).c_str(), stdout);
  return 0;
}

}  // namespace
}  // namespace fatmc::fit

int main() { return fatmc::fit::run(); }
