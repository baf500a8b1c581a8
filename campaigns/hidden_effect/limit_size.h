// The size of a limit. A delay of a quarter is a quarter of the delay; a limit has no nominal value to be a share of, and what it
// does to a flight falls to nothing where the servo's demand no longer reaches it.
//
// So a share of a limit is the limit that changes the measured rates by that share: with d(L) the root mean square, over p, q, r
// and a noise-free flight of the experiment, of the rates with the limit L minus those without, L' solves d(L') = share d(L).
// Effects are drawn and sized by flights alone: this file and limit_size.cc include nothing of core/discrepancy.
#pragma once

#include <Eigen/Core>

#include "core/flight/effects/effect.h"

namespace fatmc::hidden_effect {

struct LimitSearch {
  static constexpr double kTolerance = 0.01;  ///< of the share, relative
  static constexpr int kMostFlights = 40;
};

/// The effect with its limits at `share` of their size in this experiment; others as they are. Where the flights cannot tell (the
/// limit is never met, or the aircraft leaves its model) the effect is returned unchanged.
Effect share_of_limit(const Effect& effect, double share, const Aircraft& aircraft, const FlightSetup& setup,
                      const Eigen::Ref<const Eigen::MatrixX3d>& reference);

}  // namespace fatmc::hidden_effect
