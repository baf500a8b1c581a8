// The high-order vector-ARX problem of PBSIDopt (H A.6, A.9): predictor Markov parameters by regularised
// least squares.
//
//   y_t = sum_{l=1..p} Xi_l z_{t-l} + e_t,   z = [u; y],   Xi_l = C A_K^{l-1} B_K
//   min ||Y - Xi Phi||_F^2 + lambda^2 ||Xi||_F^2
//
// Lags stand most recent first, phi_t = [z_{t-1}; ...; z_{t-p}] (H A.8 has the oldest first): the problem of
// a smaller p is a leading block of a larger one's, and C A_K^i becomes a shift to the left by i blocks.
// Maneuvers stand one below the other (A.15); each begins with its own p samples of past.
//
// [Phi^T Y^T] = Q [R b; 0 r] by Householder reflections; the normal equations never appear.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>

#include "core/base/error.h"
#include "core/subspace/maneuvers.h"
#include "core/subspace/ridge_choice.h"

namespace fatmc {

/// R factor of the regression: all that is needed of the data.
struct PredictorFactor {
  int past = 0;  ///< p
  int n_u = 0, n_y = 0;
  Eigen::Index equations = 0;  ///< M = sum (N_j - p)
  Eigen::MatrixXd r;           ///< p n_z x p n_z, upper triangular
  Eigen::MatrixXd b;           ///< p n_z x n_y, leading rows of Q^T Y^T
  Eigen::VectorXd residual;    ///< n_y, sum of squares that no Xi explains

  [[nodiscard]] int n_z() const { return n_u + n_y; }
};

/// Fails as check_maneuvers does, where the past is below 1, a maneuver has no sample beyond it, or there are
/// fewer equations than unknowns; the message names the largest past that works.
Status check_past_window(std::span<const Maneuver> maneuvers, int past);

/// Fails where R with that diagonal is singular to rounding.
Status check_pivots(const Eigen::Ref<const Eigen::VectorXd, 0, Eigen::InnerStride<>>& diagonal);

/// Rows of Phi^T, and z_t^T = [u_t^T y_t^T], for the samples first <= t < last of every maneuver (first >= past; a last
/// beyond its end: to its end), one maneuver below the other.
struct PredictorEquations {
  Eigen::MatrixXd phi, z;
};
PredictorEquations predictor_equations(std::span<const Maneuver> maneuvers, int past, Eigen::Index first,
                                       Eigen::Index last);

/// Fails as check_past_window does.
Result<PredictorFactor> factor_predictor(std::span<const Maneuver> maneuvers, int past);

struct PredictorMarkov {
  Eigen::MatrixXd xi;  ///< n_y x p n_z, [Xi_1 ... Xi_p]
  double lambda = 0.0;
  double freedom = 0.0;  ///< sum f_i: parameters an output is worth
  double condition =
      0.0;  ///< largest over smallest singular value of Phi; 0 where they were not needed (fixed)
};

/// Fails where lambda is 0 and R is singular to rounding.
Result<PredictorMarkov> solve_predictor(const PredictorFactor& factor, const RegularizationOptions& options);

}  // namespace fatmc
