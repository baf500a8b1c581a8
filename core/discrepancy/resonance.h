// Signatures of a flexible mode at any frequency and damping, from that of a broad one.
//
// A mode adds H(s) delta to the gyro, H = -k w^2 s/(s^2 + 2 z w s + w^2) (core/flight/additional_dynamics.h); what the loop makes
// of it is the same whatever the mode, to first order in k. So with s = 2 pi i f at a line of frequency f the change of its
// features is proportional to H, and that of a mode (w, z) is that of the broad mode (w_b, z_b), flown once, times
//   H/H_b = w^2 (s^2 + 2 z_b w_b s + w_b^2) / (w_b^2 (s^2 + 2 z w s + w^2)).
// A mode of damping 0.03 is some 6 % of its frequency wide: the grid of frequencies on which it would have to be flown is a
// hundred times dearer than this.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/discrepancy/feature_layout.h"
#include "core/flight/effects/effect.h"

namespace fatmc {

/// The broad mode that is flown for this candidate: none where it is no flexible mode.
std::optional<Effect> broad_resonance(const Effect& variant);

/// Modes in 2 % steps of the frequency, three dampings each, and the change of the line features by each of them (a column
/// each; other features 0), from `difference`, the change by broad_resonance().
struct ResonanceGrid {
  std::vector<Effect> effects;
  Eigen::MatrixXd differences;
};
ResonanceGrid resonance_grid(const FeatureLayout& layout, const Effect& broad,
                             const Eigen::Ref<const Eigen::VectorXd>& difference);

}  // namespace fatmc
