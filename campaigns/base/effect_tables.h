// Effects of a model file:
//
//   [[effect]]
//   id = "control_effectiveness"     # fatmc simulate --effect list
//   axis = "pitch"
//   factor = 0.8
#pragma once

#include <vector>

#include "campaigns/base/tree.h"
#include "core/base/error.h"
#include "core/flight/effects/effect.h"

namespace fatmc {

/// The effects of the tables; an error names file, line and key.
Result<std::vector<Effect>> decode_effects(const std::vector<const Tree*>& tables);

/// A table that reads back to the effect.
std::string effect_toml(const Effect& effect);

}  // namespace fatmc
