// Control laws around a continuous model, as H evaluates them: output feedback and a filter in one input.
#pragma once

#include <Eigen/Core>

#include "core/subspace/discrete_model.h"

namespace fatmc {

/// u = r - K y closed, from r to y; K n_u x n_y. H neglects delays, actuators and notches here, and so does this.
ContinuousModel with_feedback(const ContinuousModel& model, const Eigen::Ref<const Eigen::MatrixXd>& gain);

/// 1 + gain (b2 s^2 + b1 s) / (s^2 + 2 damping w s + w^2), H (15b).
struct InputFilter {
  double gain = 0.0, b2 = 0.0, b1 = 0.0;
  double damping = 0.0, frequency_rad_s = 0.0;
};

/// The model with the filter before input `input` (two states more, last).
ContinuousModel with_input_filter(const ContinuousModel& model, Eigen::Index input,
                                  const InputFilter& filter);

/// H (14) for inputs (dx, dy, dp, d0) in per cent and outputs (u, v, w, p, q, r, phi, theta) in SI and rad:
/// K_q = 50, K_theta = 60, K_p = 60, K_phi = 50, K_r = 50.
Eigen::MatrixXd act_fhs_gain();

/// H (15b): K_y = 0.9, b2 = 0.4, b1 = -6, D = 0.6, w0 = 12.6 rad/s, in the lateral input (index 1).
InputFilter act_fhs_filter();
inline constexpr Eigen::Index kLateralInput = 1;

/// The three vehicles of H section 5.
ContinuousModel stabilized_vehicle(const ContinuousModel& bare);
ContinuousModel optimized_vehicle(const ContinuousModel& bare);

}  // namespace fatmc
