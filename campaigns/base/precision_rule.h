// How precise an answer has to be, and when it is.
//
//   [stop]                             # ends each cell as soon as the interval is narrow enough
//   metric = "share_inside_95"         # of the rows; "failed" is 1 for a trial that is not ok, else 0
//   half_width = 0.01
//   level = 0.95                       # of the interval, whenever it is looked at
//   method = "bernstein"               # or "normal"; default: bernstein where bounds are given
//   bounds = [0.0, 1.0]                # that no value leaves: bernstein needs them
//   missing = 0.0                      # value of a trial without the metric; default: it is left out
//   minimum = 20                       # trials before which nothing is decided
//   tuned_for = 500                    # trials at which the interval is to be narrowest; changes width, not
//   validity
//
//   [watch]                            # the same keys without half_width: shown, nothing is stopped
//
// The mathematics: core/stats/confidence_sequence.h.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "campaigns/base/tree.h"
#include "campaigns/base/trial_row.h"
#include "core/base/error.h"
#include "core/stats/confidence_sequence.h"

namespace fatmc {

struct PrecisionRule {
  std::string metric;
  std::optional<double> half_width;  ///< none: watched only
  ConfidenceSequenceOptions sequence;
  std::optional<double> missing;
  std::uint64_t minimum = 20;

  /// What a trial contributes; none where it is left out.
  [[nodiscard]] std::optional<double> value(const TrialRow& row) const;
};

/// [stop], or else [watch], or none.
Result<std::optional<PrecisionRule>> decode_precision(const Tree& spec);

}  // namespace fatmc
