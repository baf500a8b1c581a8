// Leading singular directions of a large upper triangular matrix, by block Krylov iteration with restarts.
//
// Block Golub-Kahan steps from a block X give orthonormal bases of X, T^T T X, ..., (T^T T)^steps X and of T
// times it; the singular value decomposition of T on the first gives the next X (Golub & Van Loan 10.4; Musco
// & Musco 2015). T^T T is never formed and no block is multiplied by it in one go, so that small singular
// values keep their digits.
#pragma once

#include <Eigen/Core>

#include "core/base/error.h"

namespace fatmc {

struct LeadingOptions {
  int steps = 3;             ///< products with T^T T before a restart
  int guard = 8;             ///< directions carried beyond those wanted: they take the slowest convergence
  double tolerance = 1e-13;  ///< of LeadingSubspace::residual
  int most_restarts = 200;
  Eigen::Index dense_size = 240;  ///< up to here a full decomposition
};

struct LeadingSubspace {
  Eigen::MatrixXd u;  ///< right singular vectors of T, size x (wanted + guard), as far as there are so many
  Eigen::VectorXd s;  ///< descending, as many
  /// Worst over those wanted of the part of T^T w_i, w_i = T u_i / s_i, outside the block, over s_1.
  double residual = 0.0;
  int restarts = 0;
};

/// The `wanted` leading directions. `start`: a block to begin with, such as the result for a leading block of
/// T (missing rows are zeros); may be empty. Fails where the iteration does not converge.
Result<LeadingSubspace> leading_subspace(const Eigen::Ref<const Eigen::MatrixXd>& triangle, int wanted,
                                         const Eigen::MatrixXd& start, const LeadingOptions& options = {});

}  // namespace fatmc
