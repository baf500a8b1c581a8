// An identified model as a MODEL of kind state_space.
#pragma once

#include <string>
#include <vector>

#include "core/subspace/discrete_model.h"

namespace fatmc::cli {

/// x[n+1] = A x[n] + B u[n], y[n] = C x[n] at `rate_hz`; `origin` says in a comment where it comes from. Decimals read
/// back bit for bit.
std::string state_space_toml(const std::string& origin, double rate_hz,
                             const std::vector<std::string>& inputs, const std::vector<std::string>& outputs,
                             const DiscreteModel& model);

}  // namespace fatmc::cli
