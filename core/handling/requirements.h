// Requirements on oscillations: CS-27 appendix B VI (instrument flight) and ADS-33.
//
// UNVERIFIED: H prints neither boundary; they are quoted from the standards from memory.
#pragma once

#include <span>
#include <string_view>

#include "core/handling/modes.h"

namespace fatmc {

/// Peaks below 5 % of the largest are taken as cancelled.
inline constexpr double kSeenShare = 0.05;

enum class PilotCrew { single, two };

/// CS-27 App. B VI. Single pilot: a period below 5 s damps to half in one cycle, from 5 to 10 s in two, from
/// 10 to 20 s is damped. Two pilots: below 5 s to half in two cycles, from 5 to 10 s damped, from 10 s on does
/// not double within 10 s. Longer periods of a single pilot are not judged here and count as met.
bool meets_cs27(const Mode& mode, PilotCrew crew);

enum class Approval { single_pilot, dual_pilot, none };
/// What the oscillations of a response allow whose share of it is at least `least_share`.
Approval cs27_approval(std::span<const ModeShare> modes, double least_share);
std::string_view approval_name(Approval approval);

/// ADS-33, oscillations of the piloted axis: level 1 damping of at least 0.35 from 0.5 rad/s on; level 2 at
/// least 0 there, and below it no faster growth than doubling in 10 s; else 3. Below 0.5 rad/s level 1 wants a
/// damping of at least 0. Where the standard's own boundary is finer it is not known here.
int ads33_level(const Mode& mode);
/// The worst of all oscillations whose share of the response is at least `least_share`; 1 where there is none.
int ads33_level(std::span<const ModeShare> modes, double least_share);

}  // namespace fatmc
