// What a cell of the hidden-effect study hides, and what is expected of the search: declared in the spec, before the run.
//
//   [[cell]]
//   name = "single"
//   repetitions = 2000
//   tier = "single"              # which bars hold: null, single, quarter, two, unknown, guard; absent: none
//   hide = 1                     # effects at once
//   size = 1.0                   # share of a moderate size
//   hidden = ["transport_delay", "control_effectiveness:axis=roll"]   # ids or names that it draws from
//   absorbable = ["cubic_moment"]  # of a tier "unknown": what other candidates can imitate in this experiment
//   taken_out = true             # what is hidden is no candidate of the search in that trial
//   levels = [1.0, 0.4]          # a record a level: factors on the excitation's amplitude
//   nominal_error = [0.03, 0.05] # relative error, of either sign, of each derivative in `uncertain`
//   uncertain = ["cl_p", "cm_alpha"]
//   turbulence_error = 0.2       # of the level's logarithm; the search then takes it for unknown
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "campaigns/base/tree.h"
#include "campaigns/hidden_effect/hidden_draw.h"
#include "core/base/error.h"

namespace fatmc::hidden_effect {

/// Which bars of the study a cell is judged by.
enum class Role { none, null, single, quarter, two, unknown, guard };

struct HiddenTier {
  Role role = Role::none;
  Tier draw;
  bool taken_out = false;
  std::vector<std::string> absorbable;  ///< ids or names
  std::vector<double> levels{1.0};
};

/// Keys of a cell that belong to this study.
inline constexpr const char* kTierKeys[] = {
    "tier",      "hide",   "size",          "hidden",    "absorbable",
    "taken_out", "levels", "nominal_error", "uncertain", "turbulence_error"};

/// Reads those keys of a cell's table; the error names file, line and key.
Result<HiddenTier> decode_hidden_tier(const Tree& cell);

/// Whether the words name the effect, by id or by id and choices.
bool named_by(const std::vector<std::string>& words, const Effect& effect);

}  // namespace fatmc::hidden_effect
