// How well an identified model repeats a maneuver, initial state and offsets being fitted (H 6-9).
//
//   y_t = y_t(x_0 = 0) + C A^t x_0 + y_0
//
// x_0 and y_0 solve linear least squares on y_m - y(x_0 = 0). Of x_0 only the modes of the lowest natural
// frequencies are free, so that models of high order cannot fit the record by their start; the others begin
// at zero.
#pragma once

#include <Eigen/Core>
#include <string_view>

#include "core/base/error.h"
#include "core/subspace/discrete_model.h"
#include "core/subspace/maneuvers.h"

namespace fatmc {

/// H's number of free initial states. A pair that would be cut in two stays at zero.
inline constexpr int kFreeInitialStates = 8;

struct ModelFit {
  Eigen::MatrixXd outputs;  ///< samples x n_y, as simulated
  Eigen::VectorXd x0;       ///< free initial states, modal coordinates
  Eigen::VectorXd y0;       ///< n_y
};

/// Fails where the model has no modal form or its simulation is not finite (a strongly unstable model).
Result<ModelFit> fit_maneuver(const DiscreteModel& model, const Maneuver& maneuver,
                              int free_states = kFreeInitialStates);

/// The same for a model whose modal form is at hand.
Result<ModelFit> fit_maneuver(const ModalModel& modal, const Maneuver& maneuver,
                              int free_states = kFreeInitialStates);

/// x_0 = 0: the response to the inputs alone.
Eigen::MatrixXd simulate(const DiscreteModel& model, const Eigen::Ref<const Eigen::MatrixXd>& inputs);

/// 100 (1 - var(y_m - y)/var(y_m)) of one output; 100 is perfect, no lower limit. `measured` must vary.
double variance_accounted_for(const Eigen::Ref<const Eigen::VectorXd>& measured,
                              const Eigen::Ref<const Eigen::VectorXd>& simulated);

/// sqrt of the mean of (y_m - y)^2 over samples and outputs, H (9): in ft/s, deg/s and deg by its convention.
double rms_error(const Eigen::Ref<const Eigen::MatrixXd>& measured,
                 const Eigen::Ref<const Eigen::MatrixXd>& simulated);

/// H (9): below 1 excellent, below 2 good, to 3.5 adequate.
std::string_view rms_rating(double j_rms);
/// H (12): from 0.94 excellent, from 0.89 good, from 0.80 adequate.
std::string_view agreement_rating(double d1);

}  // namespace fatmc
