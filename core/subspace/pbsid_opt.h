// PBSIDopt: a state-space model in innovation form from maneuvers, open or closed loop (H appendix A).
//
//   x_{t+1} = A x_t + B u_t + K e_t,   y_t = C x_t + e_t                                            (A.1, D =
//   0)
//
// 1. predictor Markov parameters (predictor_regression.h), 2. states (state_sequence.h), 3. two regressions:
//   paper     [A B] from x_{t+1} on [x_t; u_t], C from y_t on x_t (A.14); K by the Riccati equation from the
//   covariance of
//             the residuals
//   residual  C first, e_t = y_t - C x_t; then [A B K] from x_{t+1} on [x_t; u_t; e_t]. No Riccati equation,
//   and nothing
//             keeps A - K C stable
// Where a controller without delay feeds y_t back into u_t, u_t and e_t are correlated: e_t stands in the
// residual of (A.14) as K e_t, so that `paper` is biased there while `residual`, which has e_t among its
// regressors, is not (the test shows both). With a delay of one sample in the loop, or in open loop, both are
// unbiased.
//
// t runs over p ... N-2 of each maneuver (A.14 written for all of them, A.15).
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/base/error.h"
#include "core/subspace/maneuvers.h"
#include "core/subspace/predictor_regression.h"
#include "core/subspace/state_sequence.h"

namespace fatmc {

enum class FinalRegression { paper, residual };

struct PbsidOptions {
  int past = 20;    ///< p; long enough that A_K^p is negligible: see PbsidModel::predictor_norm
  int future = 20;  ///< f <= p
  int order = 8;    ///< n
  RegularizationOptions regularization;
  FinalRegression final_regression = FinalRegression::paper;
};

struct PbsidModel {
  Eigen::MatrixXd a, b, c, k;
  Eigen::VectorXcd eigenvalues;     ///< of A
  Eigen::VectorXd singular_values;  ///< of O K Phi
  Eigen::MatrixXd innovation;       ///< n_y x n_y, covariance of e
  double lambda = 0.0;
  double freedom = 0.0;           ///< parameters an output of the regression is worth
  double predictor_norm = 0.0;    ///< spectral norm of A_K^p, A_K = A - K C: neglected in (A.5)
  double predictor_radius = 0.0;  ///< largest |eigenvalue| of A_K
  double riccati_residual = 0.0;  ///< 0 for `residual`
};

/// Fails with the reason: windows or order that the data cannot carry, collinear inputs, no stabilising
/// Riccati solution.
Result<PbsidModel> identify_pbsid(std::span<const Maneuver> maneuvers, const PbsidOptions& options);

/// The last step alone, from states that are known.
Result<PbsidModel> regress_model(std::span<const Maneuver> maneuvers, const StateMap& map,
                                 const PbsidOptions& options);

/// Fills in what follows from A, C and K: eigenvalues, radius and norm of the predictor.
Status describe_predictor(int past, PbsidModel& model);

}  // namespace fatmc
