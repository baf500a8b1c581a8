// The large factorisations of subspace identification, by LAPACK and BLAS on one thread: results then do not
// depend on how many cores a worker was given. Matrices are column-major with any outer stride.
#pragma once

#include <Eigen/Core>

namespace fatmc {

/// [r rhs; rows row_rhs] -> [r' rhs'; 0 rest] by Householder reflections, r upper triangular before and after:
/// what a least-squares problem becomes when equations are added to it. n x n, n x k, q x n, q x k; what
/// stands below the diagonal of r is neither read nor written. `rows` is destroyed, `row_rhs` holds the rest.
/// 2 n^2 q operations.
void append_rows(Eigen::Ref<Eigen::MatrixXd> r, Eigen::Ref<Eigen::MatrixXd> rhs,
                 Eigen::Ref<Eigen::MatrixXd> rows, Eigen::Ref<Eigen::MatrixXd> row_rhs);

/// The same without right-hand sides.
void append_rows(Eigen::Ref<Eigen::MatrixXd> r, Eigen::Ref<Eigen::MatrixXd> rows);

/// QR of `a` (at least as many rows as columns) in place, R above the reflections; rhs <- Q^T rhs.
void triangularise(Eigen::Ref<Eigen::MatrixXd> a, Eigen::Ref<Eigen::MatrixXd> rhs);

/// An upper triangle of this size, zero; what stands below the diagonal is not set. Of a large one the memory
/// there is never touched, so that it takes half of the square.
Eigen::MatrixXd zero_triangle(Eigen::Index size);
/// A copy of the upper triangle alone.
Eigen::MatrixXd upper_triangle(const Eigen::Ref<const Eigen::MatrixXd>& of);

/// out += a b.
void add_product(const Eigen::Ref<const Eigen::MatrixXd>& a, const Eigen::Ref<const Eigen::MatrixXd>& b,
                 Eigen::Ref<Eigen::MatrixXd> out);
/// a^T b.
Eigen::MatrixXd transposed_product(const Eigen::Ref<const Eigen::MatrixXd>& a,
                                   const Eigen::Ref<const Eigen::MatrixXd>& b);

/// x <- T x or T^T x, T upper triangular.
void multiply_triangle(const Eigen::Ref<const Eigen::MatrixXd>& triangle, bool transposed,
                       Eigen::Ref<Eigen::MatrixXd> x);
/// x <- T^-1 x, T upper triangular with a diagonal that is not zero.
void solve_triangle(const Eigen::Ref<const Eigen::MatrixXd>& triangle, Eigen::Ref<Eigen::MatrixXd> x);

/// Columns of `a` become orthonormal, spanning what they spanned. More rows than columns.
void orthonormalise(Eigen::MatrixXd& a);

/// a = u diag(s) v^T of a square matrix, s descending; false where the iteration fails. `a` is destroyed.
bool singular_decomposition(Eigen::MatrixXd& a, Eigen::MatrixXd& u, Eigen::VectorXd& s, Eigen::MatrixXd& v);

}  // namespace fatmc
