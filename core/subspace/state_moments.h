// The last step of PBSIDopt (H A.14) from second moments, for all orders at once.
//
// The states of order n are the first n of those of a larger order (the singular vectors are), so that every
// moment needed is a leading block of one set. In the scaled states v_t = S^-1 U^T LK phi_t = S^-1/2 x_t the
// moment sum v v^T is the identity but for the last sample of each maneuver: the normal equations of (A.14)
// are well conditioned, unlike those of x. Formed are only products of matrices of 2 n columns with T:
//   sum v v^T        = S^-1 W^T W S^-1,             W  = T_f U
//   v_{t+1}          = G z_t + v~_t,                G  = S^-1 U^T [Xi_1; ...; Xi_f]
//   sum v~ v^T       = S^-1 W~^T W S^-1,            W~ = T(:, n_y ... n_y + n_y f) U: block rows 2 ... f + 1 of LK
// over t = p ... N-1; then the terms of t = N-1, which has no successor, are taken off.
//
// Covariances of residuals are differences of moments: where a residual is 1e-s of its state they keep
// 16 - 2 s digits. A, B and C do not come from them; K does.
#pragma once

#include <Eigen/Core>

#include "core/base/error.h"
#include "core/subspace/leading_subspace.h"
#include "core/subspace/past_products.h"
#include "core/subspace/pbsid_opt.h"

namespace fatmc {

struct StateMoments {
  int past = 0, n_u = 0, n_y = 0;
  double samples = 0.0;
  Eigen::VectorXd s;                          ///< singular values, one a state
  Eigen::MatrixXd vv, vz;                     ///< sum v v^T, sum v z^T
  Eigen::MatrixXd next_v, next_z, next_next;  ///< with v_{t+1} on the left
  Eigen::MatrixXd zz;
};

/// Of as many states as `leading` has directions wanted: `states` of them.
StateMoments state_moments(const PastProducts& products, const LeadingTriplets& leading, int future,
                           int states);

/// The model of order n <= s.size(): A, B, C and K in the coordinates x = S^1/2 v of (A.13). Fails as
/// regress_model does. `singular_values` are the leading ones alone; lambda and freedom are for the caller.
Result<PbsidModel> moment_model(const StateMoments& moments, int order, FinalRegression final_regression);

}  // namespace fatmc
