// A sampled model without direct feedthrough, its continuous form, and the bases in which one looks at it.
#pragma once

#include <Eigen/Core>

#include "core/base/error.h"

namespace fatmc {

/// x_{t+1} = A x_t + B u_t, y_t = C x_t.
struct DiscreteModel {
  Eigen::MatrixXd a, b, c;
};

/// dx/dt = A x + B u, y = C x + D u. D is zero but for the bilinear transform.
struct ContinuousModel {
  Eigen::MatrixXd a, b, c, d;
};

enum class Continuation {
  zoh,       ///< inputs held between samples: exp([A B; 0 0] T) = [A_d B_d; 0 I]
  bilinear,  ///< z = (1 + s T/2)/(1 - s T/2)
};

/// H contradicts itself: its text takes the zero-order hold, (A.16) the bilinear transform. Held inputs are
/// what a record of commands has, so zoh is the default of the commands; bilinear warps frequencies (s = 2/T
/// (z - 1)/(z + 1)) and leaves D = -C (I + A)^-1 B, which (A.16) drops. Fails where A has an eigenvalue on
/// the negative real axis or at 0 (zoh: no real logarithm) or at -1 (bilinear).
Result<ContinuousModel> continuous_model(const DiscreteModel& model, double sample_time_s,
                                         Continuation continuation);

/// Coordinates in which A is block diagonal, real modes 1 x 1, pairs 2 x 2 [re im; -im re], ascending by |ln
/// lambda|, that is by natural frequency. Fails where A is defective (eigenvectors dependent to 1e12).
struct ModalModel {
  DiscreteModel model;
  Eigen::VectorXcd eigenvalues;  ///< in the order of the states, pairs with the positive imaginary part first
};
Result<ModalModel> modal_model(const DiscreteModel& model);

/// Coordinates whose first n_y states are the outputs: x' = [C; N^T] x, N an orthonormal basis of the null
/// space of C. Fails where C has not full row rank.
Result<DiscreteModel> output_states_model(const DiscreteModel& model);

}  // namespace fatmc
