// Cells made of factors: every combination of their values.
//
//   [[cell]]
//   name = "nonlinear"
//   repetitions = 50
//
//   [[factor]]
//   path = "experiment.environment.turbulence_sigma_m_s"    # or paths = [...], values then being lists
//   name = "turbulence"                                     # default: the last component of the path
//   values = [0.5, 1.5, 3.0]
//   labels = ["light", "moderate", "severe"]                # default: the values
//   repetitions = [50, 100, 200]                            # default: those of the cell
//
// makes "nonlinear, turbulence=light" and so on, the last factor going fastest; with several [[cell]] each is
// combined with all factors. Names, and so the random numbers, do not depend on the order or number of
// values. Where several factors give repetitions the largest counts. A cell may also set values by itself:
//
//   [cell.set]
//   "estimator.n_e" = 7
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "campaigns/base/tree.h"
#include "core/base/error.h"

namespace fatmc {

/// The spec with plain cells in the place of `factor`; the same spec where there is none.
Result<Tree> expand_factors(const Tree& spec);

/// The values that a cell's table `set` gives, by path; nested tables count as longer paths.
std::vector<std::pair<std::string, Tree>> values_set_by(const Tree& cell);

}  // namespace fatmc
