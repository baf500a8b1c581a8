// Which two effects at once could explain what is left: a search over all pairs that needs no flight.
//
// Forward steps take the effect that explains most alone, and where two of one axis are missing that may be a third one (elevator
// effectiveness with C_m_alpha passes for the pitch inertia); what is added to it then explains the rest just well enough. Along the
// curves (effect_curve.h) of two candidates a and b, whose changes are taken to add up, both gain together
//
//   2 (m_a + m_b)^T r - |m_a + m_b|^2 = g_a(t) + g_b(u) - 2 m_a(t)^T m_b(u),   g the gain of one alone (candidate_scan.h),
//
// As m = A s with the signatures A and few weights s, products of signatures are formed once for a basis and a pair costs a few
// small products. Sizes are first taken from a grid, then refined by Gauss-Newton steps. It is a start for fits with real
// simulations: that effects change the noise, and each other, is left to those.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/discrepancy/comparison.h"

namespace fatmc {

struct CandidatePair {
  std::array<Effect, 2> effects;  ///< at the values that gain most together
  double gain = 0.0;
};

/// The `most` best pairs of candidates with one parameter, the best first, none of them in `excluded` (ids). `residual`: white.
std::vector<CandidatePair> scan_pairs(const Comparison& comparison,
                                      const Eigen::Ref<const Eigen::VectorXd>& residual,
                                      const std::vector<std::string>& excluded, std::size_t most);

}  // namespace fatmc
