// Leading singular triplets of a large upper triangular matrix T, by a block Davidson method on orthonormal
// bases R and L of both sides with T R = L M (Golub & Van Loan 10.4; Morgan & Scott 1986; Zha & Simon 1999 for
// what columns that are appended do to a decomposition).
//
// A round takes T u_i = s_i w_i from the decomposition of the small M, and the part of T^T w_i outside R into R.
// T^T T is never formed, so that small singular values keep their digits. A decomposition of a leading block of
// T is one of T itself on vectors that end in zeros: with the new unit vectors, whose products are columns of T,
// added to many more triplets than are wanted, little is left to iterate, and nothing of it was multiplied by T.
#pragma once

#include <Eigen/Core>

#include "core/base/error.h"

namespace fatmc {

struct LeadingOptions {
  int kept = 160;            ///< triplets that come out, and to which a space that has grown too large is cut
  int most_columns = 480;    ///< of R
  double tolerance = 1e-13;  ///< of LeadingTriplets::residual
  int most_rounds = 400;
  Eigen::Index dense_size = 320;  ///< up to here a full decomposition
};

struct LeadingTriplets {
  /// Right and left singular vectors, size x (wanted ... kept), T u = w diag(s). Beyond those wanted they are not converged.
  Eigen::MatrixXd u, w;
  Eigen::VectorXd s;  ///< descending, as many
  /// Worst over those wanted of the part of T^T w_i outside the space, over s_1.
  double residual = 0.0;
  int rounds = 0;  ///< decompositions of M; 0: full decomposition
};

/// The `wanted` leading triplets, those of a leading block of T to begin with if `start` has any. Fails where
/// the iteration does not converge.
Result<LeadingTriplets> leading_triplets(const Eigen::Ref<const Eigen::MatrixXd>& triangle, int wanted,
                                         const LeadingTriplets& start = {},
                                         const LeadingOptions& options = {});

}  // namespace fatmc
