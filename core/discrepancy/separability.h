// Which effects these records could tell apart, before anything is measured.
//
// An effect of change m (white) is detected by |m|^2, the noncentrality of its likelihood ratio. Another effect, at the size where
// it comes nearest, leaves d^2 = min_t |m - m'(t)|^2 = |m|^2 sin^2(angle): twice the log-likelihood that separates the two in the
// mean, in a record that carries the first. Where d^2 is below kClassGain (diagnosis.h) the answer is a class of both.
#pragma once

#include <vector>

#include "core/discrepancy/comparison.h"

namespace fatmc {

struct Separation {
  Effect effect;           ///< at a moderate size
  double energy = 0.0;     ///< |m|^2
  Effect nearest;          ///< at the size where it comes nearest
  double angle_deg = 0.0;  ///< between the two changes; 90: nothing of it can be explained
  double left = 0.0;       ///< d^2
};

/// The nearest other effect to every candidate at its least and its largest moderate size, on the side of nominal where the first
/// signature stands, and to effects of the library that are no candidates (they are flown for it); those that are hardest to
/// separate first.
std::vector<Separation> separations(const Comparison& comparison);

}  // namespace fatmc
