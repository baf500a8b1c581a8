// States from predictor Markov parameters (H A.10-A.13).
//
//   O K = [Xi_1 Xi_2 ... Xi_p; Xi_2 ... Xi_p 0; ...; Xi_f ... Xi_p 0 ... 0]      f n_y x p n_z, lags most
//   recent first O X = O K Phi = U S V^T,   X = S_n^{1/2} V_n^T = S_n^{-1/2} U_n^T O K Phi
//
// With Phi^T = Q R the singular values and U are those of O K R^T: Phi itself, and V, are never formed. A
// state is a sum over lags of blocks of the map S_n^{-1/2} U_n^T O K, applied to the maneuvers directly.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/base/error.h"
#include "core/subspace/maneuvers.h"
#include "core/subspace/predictor_regression.h"

namespace fatmc {

struct StateMap {
  int past = 0;
  Eigen::MatrixXd map;              ///< n x p n_z, x_t = map phi_t
  Eigen::VectorXd singular_values;  ///< of O K Phi, descending, min(f n_y, p n_z) of them
};

/// `future`: f <= p. Fails where n exceeds f n_y or p n_z, or the n-th singular value is round-off of the
/// first.
Result<StateMap> state_map(const PredictorFactor& factor, const PredictorMarkov& markov, int future,
                           int order);

/// O K of the first `future` block rows.
Eigen::MatrixXd shifted_markov(const PredictorMarkov& markov, int n_z, int future);

/// x_t for t = p ... N-1 of a maneuver, (N - p) x n.
Eigen::MatrixXd state_sequence(const StateMap& map, const Maneuver& maneuver);

}  // namespace fatmc
