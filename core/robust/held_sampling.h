// A continuous model as a record of held inputs sees it.
#pragma once

#include <optional>

#include "core/robust/nominal_model.h"

namespace fatmc {

/// dx/dt = A x + B u, y = C x + D u with u constant over each `step_s`: exp([A B; 0 0] T) = [A_d B_d; 0 I], C and D as they
/// are. None where A is not finite or the exponential overflows.
std::optional<SampledModel> sample_held(const SampledModel& continuous, double step_s);

}  // namespace fatmc
