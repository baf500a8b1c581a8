// The regularization parameter of (H A.9) from the data.
#pragma once

#include <Eigen/Core>

namespace fatmc {

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

/// A ridge problem min ||Y - Xi Phi||^2 + lambda^2 ||Xi||^2 as far as the rules see it.
struct RidgeSpectrum {
  Eigen::VectorXd s;         ///< singular values of Phi, descending
  Eigen::VectorXd energy;    ///< sum over outputs of the squares of Y in each left singular direction
  double unexplained = 0.0;  ///< squares of Y that no Xi explains
  double equations = 0.0;    ///< M
};

/// The value that `rule` (not `fixed`) chooses.
double chosen_lambda(const RidgeSpectrum& problem, Regularization rule);

}  // namespace fatmc
