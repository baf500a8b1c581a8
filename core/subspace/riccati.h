// Discrete algebraic Riccati equation of the Kalman filter, by structure-preserving doubling.
//
//   P = A P A^T + Q - (A P C^T + S) (C P C^T + R)^-1 (A P C^T + S)^T,   K = (A P C^T + S) (C P C^T + R)^-1
//
// The cross covariance S goes first: A' = A - S R^-1 C, Q' = Q - S R^-1 S^T, K = K' + S R^-1. Then doubling
// (Chu, Fan, Lin & Wang 2004) on the transposed pair, quadratically convergent,
//   A_{k+1} = A_k (I + G_k H_k)^-1 A_k
//   G_{k+1} = G_k + A_k (I + G_k H_k)^-1 G_k A_k^T
//   H_{k+1} = H_k + A_k^T H_k (I + G_k H_k)^-1 A_k,        A_0 = A'^T, G_0 = C^T R^-1 C, H_0 = Q',  H_k -> P
#pragma once

#include <Eigen/Core>

#include "core/base/error.h"

namespace fatmc {

struct NoiseCovariance {
  Eigen::MatrixXd q;  ///< n x n, of the states' residuals
  Eigen::MatrixXd s;  ///< n x n_y, of states' and outputs' residuals
  Eigen::MatrixXd r;  ///< n_y x n_y, of the outputs' residuals
};

struct KalmanGain {
  Eigen::MatrixXd k;      ///< n x n_y
  Eigen::MatrixXd p;      ///< n x n, stabilising solution
  double residual = 0.0;  ///< Frobenius norm of the equation's residual over ||P|| + ||Q||
  int iterations = 0;
  double predictor_radius = 0.0;  ///< largest |eigenvalue| of A - K C
};

/// Fails where R is not positive definite, the iteration does not converge, the residual exceeds 1e-8, or A -
/// K C is not stable: then there is no stabilising solution to the digits at hand.
Result<KalmanGain> kalman_gain(const Eigen::Ref<const Eigen::MatrixXd>& a,
                               const Eigen::Ref<const Eigen::MatrixXd>& c, const NoiseCovariance& noise);

}  // namespace fatmc
