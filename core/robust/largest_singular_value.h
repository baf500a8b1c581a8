// σ_max of a small complex matrix with its singular vectors, for the inner loop of the structured singular value.
#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>

namespace fatmc {

/// The Gram matrix N Nᴴ seen from its largest eigenvalue.
template <int Rows>
struct LargestEigenpair {
  double value = 0.0;
  Eigen::Matrix<std::complex<double>, Rows, 1> vector;  ///< unit length
  double gap = 0.0;                                      ///< (λ1 − λ2) / λ1
};

/// By the dense Hermitian solver; any size.
template <int Rows>
LargestEigenpair<Rows> largest_eigenpair_dense(const Eigen::Matrix<std::complex<double>, Rows, Rows>& gram) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<std::complex<double>, Rows, Rows>> solver(gram);
  const Eigen::Index n = gram.rows();
  LargestEigenpair<Rows> out;
  out.value = solver.eigenvalues()(n - 1);
  out.vector = solver.eigenvectors().col(n - 1);
  out.gap = n > 1 && out.value > 0.0 ? (out.value - solver.eigenvalues()(n - 2)) / out.value : 1.0;
  return out;
}

/// 3 × 3: λ1 from the characteristic cubic, its vector as the largest cross product of rows of H − λ1 I, and one
/// Rayleigh quotient, which squares the error of the vector. Where λ1 is nearly multiple the cross product is
/// inaccurate, and the dense solver takes over.
inline LargestEigenpair<3> largest_eigenpair(const Eigen::Matrix3cd& h) {
  const double trace = h(0, 0).real() + h(1, 1).real() + h(2, 2).real();
  const double q = trace / 3.0;
  const double d0 = h(0, 0).real() - q, d1 = h(1, 1).real() - q, d2 = h(2, 2).real() - q;
  const double off = std::norm(h(0, 1)) + std::norm(h(0, 2)) + std::norm(h(1, 2));
  const double p2 = (d0 * d0 + d1 * d1 + d2 * d2 + 2.0 * off) / 6.0;
  if (!(p2 > 1e-20 * q * q)) return largest_eigenpair_dense<3>(h);
  const double p = std::sqrt(p2);
  const double det = d0 * d1 * d2 + 2.0 * (h(0, 1) * h(1, 2) * std::conj(h(0, 2))).real() -
                     d0 * std::norm(h(1, 2)) - d1 * std::norm(h(0, 2)) - d2 * std::norm(h(0, 1));
  const double r = std::clamp(det / (2.0 * p2 * p), -1.0, 1.0);
  const double angle = std::acos(r) / 3.0;
  // Eigenvalues q + 2 p cos(angle + 2πk/3); angle in [0, π/3], so that k = 0 is the largest.
  const double sine = std::sqrt(3.0) * std::sin(angle);
  const double value = q + 2.0 * p * std::cos(angle);
  const double second = q - p * (std::cos(angle) - sine);
  LargestEigenpair<3> out;
  out.gap = (value - second) / value;
  if (out.gap < 1e-3) return largest_eigenpair_dense<3>(h);
  Eigen::Matrix3cd shifted = h;
  for (int i = 0; i < 3; ++i) shifted(i, i) -= value;
  // A vector orthogonal to two rows of a Hermitian matrix: the conjugate of their cross product.
  Eigen::Vector3cd best;
  double best_norm = -1.0;
  for (int i = 0; i < 3; ++i) {
    const int a = i, b = (i + 1) % 3;
    const Eigen::Vector3cd cross(shifted(a, 1) * shifted(b, 2) - shifted(a, 2) * shifted(b, 1),
                                 shifted(a, 2) * shifted(b, 0) - shifted(a, 0) * shifted(b, 2),
                                 shifted(a, 0) * shifted(b, 1) - shifted(a, 1) * shifted(b, 0));
    const double norm = cross.squaredNorm();
    if (norm > best_norm) {
      best_norm = norm;
      best = cross;
    }
  }
  out.vector = best / std::sqrt(best_norm);
  out.value = (out.vector.adjoint() * (h * out.vector)).value().real();
  return out;
}

template <int Rows>
LargestEigenpair<Rows> largest_eigenpair(const Eigen::Matrix<std::complex<double>, Rows, Rows>& gram) {
  return largest_eigenpair_dense<Rows>(gram);
}

}  // namespace fatmc
