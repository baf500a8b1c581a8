// All eigenpairs of a small Hermitian matrix, for the inner loop of the structured singular value.
#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>

namespace fatmc {

/// H = Σ_k λ_k u_k u_kᴴ with λ_0 the largest; vectors are columns of unit length.
template <int N>
struct HermitianSpectrum {
  Eigen::Matrix<double, N, 1> values;
  Eigen::Matrix<std::complex<double>, N, N> vectors;
};

/// By Eigen's dense solver; any size.
template <int N>
HermitianSpectrum<N> dense_spectrum(const Eigen::Matrix<std::complex<double>, N, N>& h) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<std::complex<double>, N, N>> solver(h);
  return {solver.eigenvalues().reverse(), solver.eigenvectors().rowwise().reverse()};
}

template <int N>
HermitianSpectrum<N> hermitian_spectrum(const Eigen::Matrix<std::complex<double>, N, N>& h) {
  return dense_spectrum<N>(h);
}

/// Cosine of a third of the angle whose cosine is r in [0, 1]: the root c in [√3/2, 1] of 4c³ − 3c = r, where the
/// derivative is at least 6. Newton from a parabola that is right to 1e-3.
inline double cosine_of_third(double r) {
  double c = 0.86602540378443865 + r * (0.16666666666666667 - 0.03269207045110532 * r);
  for (int k = 0; k < 3; ++k) c -= (c * (4.0 * c * c - 3.0) - r) / (12.0 * c * c - 3.0);
  return c;
}

/// 3 × 3 in closed form, accurate also where two eigenvalues nearly coincide: the characteristic cubic gives the
/// eigenvalue that stands further from the other two, which is well conditioned; its vector is the largest cross
/// product of rows of H − λ I; the other two follow from the 2 × 2 matrix left on its complement.
inline HermitianSpectrum<3> hermitian_spectrum(const Eigen::Matrix3cd& h) {
  using Complex = std::complex<double>;
  const double trace = h(0, 0).real() + h(1, 1).real() + h(2, 2).real();
  const double mean = trace / 3.0;
  const double d0 = h(0, 0).real() - mean, d1 = h(1, 1).real() - mean, d2 = h(2, 2).real() - mean;
  const Complex h10 = h(1, 0), h20 = h(2, 0), h21 = h(2, 1);
  const double n10 = std::norm(h10), n20 = std::norm(h20), n21 = std::norm(h21);
  const double p2 = (d0 * d0 + d1 * d1 + d2 * d2 + 2.0 * (n10 + n20 + n21)) / 6.0;
  if (!(p2 > 1e-20 * mean * mean)) return dense_spectrum<3>(h);  // all three equal to working precision
  const double p = std::sqrt(p2);
  const double det = d0 * d1 * d2 + 2.0 * (h10 * h21 * std::conj(h20)).real() - d0 * n21 - d1 * n20 - d2 * n10;
  const double r = std::clamp(det / (2.0 * p2 * p), -1.0, 1.0);
  const bool top = r >= 0.0;  // the isolated eigenvalue is the largest
  const double isolated = 2.0 * p * cosine_of_third(std::abs(r)) * (top ? 1.0 : -1.0);

  // Rows of H − λ I, Hermitian: a vector orthogonal to two of them is the conjugate of their cross product, here the
  // columns of the (Hermitian) adjugate; the one with the largest diagonal is the longest.
  const double e0 = d0 - isolated, e1 = d1 - isolated, e2 = d2 - isolated;
  const double m0 = e1 * e2 - n21, m1 = e0 * e2 - n20, m2 = e0 * e1 - n10;
  Eigen::Vector3cd u;
  if (std::abs(m0) >= std::abs(m1) && std::abs(m0) >= std::abs(m2)) {
    u << m0, std::conj(h21) * h20 - h10 * e2, h10 * h21 - h20 * e1;
  } else if (std::abs(m1) >= std::abs(m2)) {
    u << h21 * std::conj(h20) - std::conj(h10) * e2, m1, std::conj(h10) * h20 - h21 * e0;
  } else {
    u << std::conj(h10) * std::conj(h21) - std::conj(h20) * e1, std::conj(std::conj(h10) * h20) - std::conj(h21) * e0,
        m2;
  }
  u /= u.norm();

  // Complement: a from the two larger entries of u, b = conj(u × a).
  const double w0 = std::norm(u(0)), w1 = std::norm(u(1)), w2 = std::norm(u(2));
  Eigen::Vector3cd a;
  if (w2 <= w0 && w2 <= w1) {
    a << std::conj(u(1)), -std::conj(u(0)), 0.0;
    a /= std::sqrt(w0 + w1);
  } else if (w1 <= w0) {
    a << std::conj(u(2)), 0.0, -std::conj(u(0));
    a /= std::sqrt(w0 + w2);
  } else {
    a << 0.0, std::conj(u(2)), -std::conj(u(1));
    a /= std::sqrt(w1 + w2);
  }
  Eigen::Vector3cd b;
  b << std::conj(u(1) * a(2) - u(2) * a(1)), std::conj(u(2) * a(0) - u(0) * a(2)),
      std::conj(u(0) * a(1) - u(1) * a(0));
  Eigen::Vector3cd ha, hb;
  for (int i = 0; i < 3; ++i) {
    ha(i) = h(i, 0) * a(0) + h(i, 1) * a(1) + h(i, 2) * a(2);
    hb(i) = h(i, 0) * b(0) + h(i, 1) * b(1) + h(i, 2) * b(2);
  }
  double haa = 0.0, hbb = 0.0;
  Complex hab = 0.0;  // aᴴ H b
  for (int i = 0; i < 3; ++i) {
    haa += (std::conj(a(i)) * ha(i)).real();
    hbb += (std::conj(b(i)) * hb(i)).real();
    hab += std::conj(a(i)) * hb(i);
  }
  const double half = 0.5 * (haa - hbb), centre = 0.5 * (haa + hbb);
  const double radius = std::sqrt(half * half + std::norm(hab));
  // Upper vector (cos, sin·phase) without cancellation.
  Complex ca = 1.0, cb = 0.0;
  if (radius > 0.0) {
    const double big = std::sqrt(0.5 * (1.0 + std::abs(half) / radius));
    const Complex small = (half >= 0.0 ? std::conj(hab) : hab) / (2.0 * radius * big);
    ca = half >= 0.0 ? Complex(big) : small;
    cb = half >= 0.0 ? small : Complex(big);
  }
  const Eigen::Vector3cd upper(a(0) * ca + b(0) * cb, a(1) * ca + b(1) * cb, a(2) * ca + b(2) * cb);
  const Complex na = -std::conj(cb), nb = std::conj(ca);
  const Eigen::Vector3cd lower(a(0) * na + b(0) * nb, a(1) * na + b(1) * nb, a(2) * na + b(2) * nb);

  HermitianSpectrum<3> out;
  const int first = top ? 1 : 0;
  out.values(top ? 0 : 2) = trace - (haa + hbb);
  out.values(first) = centre + radius;
  out.values(first + 1) = centre - radius;
  out.vectors.col(top ? 0 : 2) = u;
  out.vectors.col(first) = upper;
  out.vectors.col(first + 1) = lower;
  return out;
}

}  // namespace fatmc
