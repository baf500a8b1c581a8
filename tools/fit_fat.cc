// Fits the FAT's unpublished aerodynamic derivatives to the poles and zeros that the thesis prints, and
// writes campaigns/models/fat.toml. Usage: fit_fat > campaigns/models/fat.toml What was reached, parameter by
// parameter, goes to standard error.
#include <cstdio>

#include "tools/fat_problem.h"
#include "tools/write_fat.h"

namespace fatmc::fit {
namespace {

int run() {
  const Problem setup = fat_problem();
  Fit fit = solve(setup);
  std::fprintf(stderr, "%s after %d iterations, last step %.2g, violation %.2g\n",
               fit.converged ? "converged" : "not converged", fit.iterations, fit.step, fit.violation);
  for (std::size_t i = 0; i < setup.targets.size(); ++i) {
    std::fprintf(stderr, "%-20s wanted %12.8g reached %12.8g\n", setup.targets[i].name.c_str(),
                 setup.targets[i].value, fit.reached[static_cast<Eigen::Index>(i)]);
  }
  for (const Parameter& p : setup.parameters) {
    const double value = p.of(fit.aircraft);
    std::fprintf(stderr, "%-8s prior %9.5g +- %-8.3g fitted %12.7g (%+.2f)\n", p.name.c_str(), p.prior,
                 p.spread, value, (value - p.prior) / p.spread);
  }
  if (!fit.converged) return 1;
  std::fputs(fat_toml(fit.aircraft).c_str(), stdout);
  return 0;
}

}  // namespace
}  // namespace fatmc::fit

int main() { return fatmc::fit::run(); }
