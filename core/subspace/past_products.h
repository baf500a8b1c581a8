// What the models of one past window have in common, whatever their future window and order.
//
// With P = LK R^T (LK of state_sequence.h for f = p, R of the regression) and P^T = Q T, T upper triangular:
// the product of a shorter future is the leading n_y f rows of P, so that its singular values are those of the
// leading n_y f x n_y f block of T and U its right singular vectors. One triangle serves all f.
//
// LK is a block Hankel matrix that vanishes below its anti-diagonal, so that row block l of P^T has
// (p - l) n_y columns only. T grows from the oldest lags, which reach few columns, to the most recent ones:
// about 900 p^3 operations at n_y = 8, n_z = 12, against 1500 p^3 for the Gram matrix P P^T, whose small
// eigenvalues would have lost half of their digits.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/subspace/maneuvers.h"
#include "core/subspace/nested_regression.h"

namespace fatmc {

struct PastProducts {
  int past = 0, n_u = 0, n_y = 0;
  Eigen::Index samples = 0;  ///< t = p ... N-2 of all maneuvers
  Eigen::MatrixXd triangle;  ///< T, p n_y x p n_y; not set below the diagonal
  /// Block i: Xi_{i+1}, the first block column of LK, p n_y x n_z.
  Eigen::MatrixXd first_column;
  /// sum LK phi_t z_t^T over t = p ... N-1, (p + 1) n_y x n_z; a block row of zeros stands below.
  Eigen::MatrixXd states_z;
  /// LK phi_{N-1} of each maneuver, (p + 1) n_y x J, likewise.
  Eigen::MatrixXd last_states;
  Eigen::MatrixXd zz;      ///< sum z_t z_t^T over t = p ... N-1
  Eigen::MatrixXd last_z;  ///< z_{N-1} of each maneuver, n_z x J
};

PastProducts past_products(const NestedRegression& regression, std::span<const Maneuver> maneuvers,
                           const Eigen::MatrixXd& xi);

}  // namespace fatmc
