// Singular values of a large triangle, and a right-hand side in the coordinates of its left singular vectors,
// without forming any vector: what the rules for lambda ask for (ridge_choice.h).
#pragma once

#include <Eigen/Core>

namespace fatmc {

/// Singular values of the upper triangle of `a`, descending, and rhs <- (left singular vectors)^T rhs. `a` is
/// destroyed, below the diagonal too. False where the iteration fails.
///
/// In two stages (Grosser & Lang 1999): block reflections from both sides to an upper band, 8/3 n^3 operations
/// in products of matrices, then rotations along the band and the QR iteration, O(n^2). One stage (dgebrd) does half of
/// its operations in products with vectors, each of which reads the whole matrix again.
bool rotate_to_singular_directions(Eigen::Ref<Eigen::MatrixXd> a, Eigen::Ref<Eigen::MatrixXd> rhs,
                                   Eigen::VectorXd& s);

}  // namespace fatmc
