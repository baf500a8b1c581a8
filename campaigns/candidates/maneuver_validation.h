// How well a model repeats maneuvers that it was not identified from, all of them together (H 3.2, 3.3): the measure by which
// the study and `fatmc select` choose.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/base/error.h"
#include "core/subspace/discrete_model.h"
#include "core/subspace/maneuvers.h"

namespace fatmc::candidates {

/// All samples of the maneuvers one below the other, samples x n_y.
Eigen::MatrixXd stacked_outputs(std::span<const Maneuver> maneuvers);

/// The same as the model gives them, each maneuver with its own x0 and y0 (H 6-8). Fails as fit_maneuver does.
Result<Eigen::MatrixXd> repeated_outputs(const ModalModel& modal, std::span<const Maneuver> maneuvers);

struct OverallAccuracy {
  std::vector<double> output_agreement;  ///< d1 of each output, H (10) corrected
  double agreement = 0.0;                ///< over all outputs, H (11)
  double rms = 0.0;                      ///< H (9), in the units given
  double theil = 0.0;  ///< of all samples of all outputs together, in the same units; 0 (equal) to 1
};

/// `units` scales the outputs for J_rms and Theil's coefficient, where their sizes add up (H takes ft/s, deg/s and deg); d1 knows
/// no units. `weights`: w_i of H (11), none for 1 each. Fails where an output never moves, or the
/// squares of the simulated ones overflow.
Result<OverallAccuracy> overall_accuracy(const Eigen::MatrixXd& measured, const Eigen::MatrixXd& simulated,
                                         const Eigen::RowVectorXd& units,
                                         std::span<const double> weights = {});

}  // namespace fatmc::candidates
