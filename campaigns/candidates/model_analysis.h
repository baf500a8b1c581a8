// What the study asks of one model: how well it repeats the multisteps, and what it says of stability and
// handling qualities.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "campaigns/candidates/row_arrays.h"
#include "core/base/error.h"
#include "core/handling/modes.h"
#include "core/subspace/discrete_model.h"
#include "core/subspace/maneuvers.h"

namespace fatmc::candidates {

struct Validation {
  double agreement = 0.0;  ///< overall d1, H (11), each output over all maneuvers one after the other
  double rms = 0.0;        ///< H (9), ft/s, deg/s, deg
  /// Roll rate of maneuver kRollManeuver alone: d1 of H (10) and deg/s (H Figs. 2 and 3).
  double roll_agreement = 0.0, roll_rms = 0.0;
};
/// Its output.
inline constexpr Eigen::Index kRollRate = 3;
/// The first multistep of the lateral control.
inline constexpr std::size_t kRollManeuver = 2;

/// Each maneuver with its own x0 and y0 (H 6-8). Fails as fit_maneuver does.
Result<Validation> validate(const ModalModel& modal, std::span<const Maneuver> maneuvers);

struct ModelAnalysis {
  std::array<double, kTrackedModes.size()> period_s{}, damping{};
  std::array<int, kJudged.size()> level{}, approval{};
  int artifacts = 0;
  std::vector<double> magnitude_db;  ///< kFrequencies values
};

/// Modes of the bare truth, against which resonances are counted.
std::vector<Mode> truth_modes(const DiscreteModel& truth, double rate_hz);

/// Oscillatory modes below kArtifactRad_s, damped less than kArtifactDamping either way, farther than kNear of
/// |s| from every oscillatory mode of the truth: resonances without physical counterpart (H 4.2).
int count_artifacts(std::span<const Mode> modes, std::span<const Mode> truth);
inline constexpr double kArtifactRad_s = 3.0, kArtifactDamping = 0.1;
inline constexpr double kNear = 0.5;
/// A mode is taken for a published one within that share of its |s|: roll/flap and lead-lag are 0.34 apart.
inline constexpr double kTrackedNear = 0.3;

/// By the zero-order hold. Fails where the model has no continuous counterpart.
Result<ModelAnalysis> analyse(const DiscreteModel& model, double rate_hz, std::span<const Mode> truth);

/// |p/delta_y| of a continuous model, deg/s per per cent in dB.
std::vector<double> roll_magnitude_db(const ContinuousModel& model, std::span<const double> rad_s);

}  // namespace fatmc::candidates
