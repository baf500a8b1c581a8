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

/// Fails where the past is below 1, a maneuver has no sample beyond it, or there are fewer equations than
/// unknowns; the message names the largest past that works.
Result<PredictorFactor> factor_predictor(std::span<const Maneuver> maneuvers, int past);

enum class Regularization {
  fixed,   ///< lambda as given; 0: plain least squares
  gcv,     ///< generalised cross validation
  srgcv,   ///< strong robust generalised cross validation
  lcurve,  ///< corner of the L-curve
};

/// How lambda is chosen. With the singular values s_i of Phi and the filter f_i = s_i^2/(s_i^2 + lambda^2),
/// all outputs together:
///   GCV    V = (RSS/M) / (1 - sum f_i / M)^2
///   SRGCV  (gamma + (1 - gamma) mu_1) V,  mu_1 = sum (s_1 s_i/(s_i^2 + lambda^2))^2 / M, gamma = 0.95
///          (Bauer & Lukas 2011, H's ref. 24; their operator is scaled, and neither H nor they fix the scale
///          here: ours is norm 1. It regularises much more than GCV where the data are ill-conditioned.)
///   lcurve largest curvature of (log RSS, log ||Xi||^2)
/// The search runs over lambda / s_1 = 10^-12 ... 1, 20 values a decade: fixed, so that the result is too.
struct RegularizationOptions {
  /// GCV: of the three rules the one without a free constant.
  Regularization rule = Regularization::gcv;
  double lambda = 0.0;  ///< for `fixed`
};

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
