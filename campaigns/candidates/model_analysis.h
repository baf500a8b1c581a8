// What the study asks of one model: how well it repeats the multisteps, and what it says of stability and
// handling qualities.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "campaigns/candidates/maneuver_validation.h"
#include "campaigns/candidates/row_arrays.h"
#include "core/base/error.h"
#include "core/handling/modes.h"
#include "core/subspace/discrete_model.h"
#include "core/subspace/maneuvers.h"

namespace fatmc::candidates {

struct Validation {
  OverallAccuracy
      overall;  ///< over all maneuvers one after the other, J_rms and Theil in ft/s, deg/s and deg
  /// Roll rate of maneuver kRollManeuver alone: d1 of H (10) and deg/s (H Figs. 2 and 3).
  double roll_agreement = 0.0, roll_rms = 0.0;
};
/// Its output.
inline constexpr Eigen::Index kRollRate = 3;
/// The first multistep of the lateral control.
inline constexpr std::size_t kRollManeuver = 2;

/// Fails as repeated_outputs and overall_accuracy do. `weights`: w_i of H (11), none for 1 each.
Result<Validation> validate(const ModalModel& modal, std::span<const Maneuver> maneuvers,
                            std::span<const double> weights = {});

struct ModelAnalysis {
  std::array<double, kTrackedModes.size()> period_s{}, damping{};  ///< 0 where no mode is near
  std::array<int, kJudged.size()> level{},
      approval{};                                ///< ADS-33; CS-27: 1 single, 2 two pilots, 3 none. 0 without
  std::array<bool, kJudged.size()> diverging{};  ///< an unstable real pole shows in the response
  int artifacts = 0;
};

/// What a model is held against.
struct TruthResponse {
  ContinuousModel bare;
  std::vector<double> magnitude_db;  ///< of p/delta_y at study_frequencies()
};
/// Fails where the truth has no continuous counterpart.
Result<TruthResponse> truth_response(const DiscreteModel& truth, double rate_hz);

/// Resonances without physical counterpart (H 4.2): oscillatory modes between the lowest of study_frequencies() and
/// kArtifactRad_s at whose frequency |p/delta_y| stands more than kArtifact_db above the truth's, once the median difference
/// over these frequencies is taken off. `magnitude_db` is the model's at study_frequencies().
int count_artifacts(const ContinuousModel& bare, std::span<const Mode> modes,
                    std::span<const double> magnitude_db, const TruthResponse& truth);
inline constexpr double kArtifactRad_s = 3.0, kArtifact_db = 6.0;
/// A mode is taken for a published one within that share of its |s|: roll/flap and lead-lag are 0.34 apart.
inline constexpr double kTrackedNear = 0.3;

/// Of a continuous model in H's units. Fails where A is not finite.
Result<ModelAnalysis> analyse(const ContinuousModel& bare, std::span<const double> magnitude_db,
                              const TruthResponse& truth);

/// |p/delta_y| of a continuous model, deg/s per per cent in dB.
std::vector<double> roll_magnitude_db(const ContinuousModel& model, std::span<const double> rad_s);

}  // namespace fatmc::candidates
