// Small complex least-squares problems, four at a time: a SIMD lane is a line.
//
// Every line of an LPM estimate solves a problem of the same shape, so that one instruction works on four lines and
// no shuffling is needed inside a problem. Matrices are column-major, element (r, c) at [c * rows + r].
#pragma once

#include <Eigen/Core>

namespace fatmc {

inline constexpr int kLanes = 4;
using Lanes = Eigen::Array<double, kLanes, 1>;

struct ComplexLanes {
  Lanes re;
  Lanes im;
};

inline ComplexLanes zero_lanes() { return {Lanes::Zero(), Lanes::Zero()}; }

/// sum += a b
inline void add_product(ComplexLanes& sum, const ComplexLanes& a, const ComplexLanes& b) {
  sum.re += a.re * b.re - a.im * b.im;
  sum.im += a.re * b.im + a.im * b.re;
}

/// sum += a conj(b)
inline void add_product_conj(ComplexLanes& sum, const ComplexLanes& a, const ComplexLanes& b) {
  sum.re += a.re * b.re + a.im * b.im;
  sum.im += a.im * b.re - a.re * b.im;
}

/// Householder QR, X = Q R, of a `rows` x `cols` matrix, rows >= cols. On return the part of column j from row j on
/// holds the reflector w_j (H_j = I - w_j w_j^H), the part above it R(0..j-1, j), and diagonal[j] = R(j, j).
void householder_factor(ComplexLanes* x, int rows, int cols, ComplexLanes* diagonal);

/// Z := Q^H Z for `z_cols` columns of `rows` elements.
void householder_apply(const ComplexLanes* x, int rows, int cols, ComplexLanes* z, int z_cols);

/// Solves R(first.., first..) S = Z in place; Z has `z_cols` columns, its element (i, c) at z[c * z_rows + i] belongs to
/// row first + i of R. R is what householder_factor left. A lane whose diagonal is zero gets zeros.
void back_substitute(const ComplexLanes* x, int rows, int cols, const ComplexLanes* diagonal, int first,
                     ComplexLanes* z, int z_rows, int z_cols);

/// C(a, b) = scale sum_r e(r, a) conj(e(r, b)), all a, b < cols; e(r, a) at e[a * stride + r], C(a, b) at [b * cols + a].
void covariance(const ComplexLanes* e, int stride, int rows, int cols, double scale, ComplexLanes* c);

}  // namespace fatmc
