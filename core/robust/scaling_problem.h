// Upper bound of the structured singular value: the convex problem in log s and log t (structured_singular_value.h).
//
// With θ = (log s_2 .. log s_out, log t_2 .. log t_in), N = diag(a) X diag(b), G = N Nᴴ = Σ λ_k u_k u_kᴴ, y_k = Nᴴ u_k:
//   F_p(θ) = (1/p) log Σ_k λ_k^p,   log λ_max ≤ F_p ≤ log λ_max + log(n)/p,
// smooth and convex for every p; p = ∞ is log σ_max² itself, smooth where its largest λ is simple. Derivatives with
// respect to α_j = log a_j² and β_i = log b_i²: with E^{α_j}_kl = ½(λ_k + λ_l) conj(u_kj) u_lj and
// E^{β_i}_kl = conj(y_ki) y_li the first derivatives of G in its own eigenvectors, ω_k = λ_k^p / Σ λ^p, e_k = E_kk/λ_k,
//   F_a  = Σ_k ω_k e_k^a,
//   F_ab = p (Σ_k ω_k e_k^a e_k^b − F_a F_b) − Σ_k ω_k e_k^a e_k^b + Σ_k ω_k (u_kᴴ G_ab u_k)/λ_k
//        + Σ_{k≠l} Re(E^a_kl conj E^b_kl) (λ_k^{p−1} − λ_l^{p−1}) / ((λ_k − λ_l) Σ λ^p),
// the derivatives of a spectral function (Daleckii and Krein), the divided difference of λ^{p−1} making them finite
// where eigenvalues coincide.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <limits>

#include "core/robust/hermitian_spectrum.h"

namespace fatmc {

template <int In, int Out>
class ScalingProblem {
 public:
  static constexpr int kVariables = In == Eigen::Dynamic ? Eigen::Dynamic : In + Out - 2;
  using Loop = Eigen::Matrix<std::complex<double>, In, Out>;
  using Radii = Eigen::Matrix<double, Out, In>;
  using InVector = Eigen::Matrix<double, In, 1>;
  using OutVector = Eigen::Matrix<double, Out, 1>;
  using Variables = Eigen::Matrix<double, kVariables, 1>;
  using Hessian = Eigen::Matrix<double, kVariables, kVariables>;
  using InSquare = Eigen::Matrix<std::complex<double>, In, In>;
  static constexpr double kExact = std::numeric_limits<double>::infinity();  ///< the power of log σ_max² itself

  /// F_power at θ with what its derivatives need.
  struct Point {
    Variables theta;
    double power = kExact;
    double value = 0.0;   ///< F_power
    double sigma2 = 0.0;  ///< λ_max
    double gap = 1.0;     ///< (λ_1 − λ_2)/λ_1
    InVector a;
    OutVector b;
    Radii into;    ///< ∂α_j/∂log s_i, indexed (i, j)
    Radii out_of;  ///< −∂β_i/∂log t_j
    InSquare gram;
    HermitianSpectrum<In> spectrum;
    InVector weights;                                             ///< ω_k
    Eigen::Matrix<std::complex<double>, Out, In> right;           ///< y_k in columns
  };

  struct Derivatives {
    Variables gradient;
    Hessian hessian;
  };

  ScalingProblem(const Loop& x, const Radii& radii) : x_(x), w_(radii) {}

  [[nodiscard]] Point evaluate(const Variables& theta, double power) const {
    const Eigen::Index n_in = x_.rows(), n_out = x_.cols();
    Point point;
    point.theta = theta;
    point.power = power;
    resize(point);
    OutVector s(n_out);
    InVector t(n_in);
    for (Eigen::Index i = 0; i < n_out; ++i) s(i) = i == 0 ? 1.0 : std::exp(theta(i - 1));
    for (Eigen::Index j = 0; j < n_in; ++j) t(j) = j == 0 ? 1.0 : std::exp(theta(n_out + j - 2));
    for (Eigen::Index j = 0; j < n_in; ++j) {
      double column = 0.0;
      for (Eigen::Index i = 0; i < n_out; ++i) column += point.into(i, j) = w_(i, j) * s(i);
      point.a(j) = std::sqrt(t(j) * column);
      const double inverse = column > 0.0 ? 1.0 / column : 0.0;
      for (Eigen::Index i = 0; i < n_out; ++i) point.into(i, j) *= inverse;
      t(j) = 1.0 / t(j);
    }
    for (Eigen::Index i = 0; i < n_out; ++i) {
      double row = 0.0;
      for (Eigen::Index j = 0; j < n_in; ++j) row += point.out_of(i, j) = w_(i, j) * t(j);
      point.b(i) = std::sqrt(row / s(i));
      const double inverse = row > 0.0 ? 1.0 / row : 0.0;
      for (Eigen::Index j = 0; j < n_in; ++j) point.out_of(i, j) *= inverse;
    }
    decompose(point);
    return point;
  }

  [[nodiscard]] Derivatives differentiate(const Point& point) const {
    const Eigen::Index n_in = x_.rows(), n_out = x_.cols();
    InVector g_in = InVector::Zero(n_in);
    OutVector g_out = OutVector::Zero(n_out);
    Curvature curvature = spectral_curvature(point, g_in, g_out);
    return chain(point, g_in, g_out, curvature);
  }

 private:
  struct Curvature {
    Eigen::Matrix<double, In, In> in;
    Eigen::Matrix<double, In, Out> cross;
    Eigen::Matrix<double, Out, Out> out;
  };

  void resize(Point& point) const {
    if constexpr (In == Eigen::Dynamic) {
      const Eigen::Index n_in = x_.rows(), n_out = x_.cols();
      point.a.resize(n_in);
      point.b.resize(n_out);
      point.into.resize(n_out, n_in);
      point.out_of.resize(n_out, n_in);
      point.gram.resize(n_in, n_in);
      point.weights.resize(n_in);
      point.right.resize(n_out, n_in);
    }
  }

  void decompose(Point& point) const {
    const Eigen::Index n_in = x_.rows(), n_out = x_.cols();
    Loop n(n_in, n_out);
    for (Eigen::Index i = 0; i < n_out; ++i) {
      for (Eigen::Index j = 0; j < n_in; ++j) n(j, i) = (point.a(j) * point.b(i)) * x_(j, i);
    }
    for (Eigen::Index j = 0; j < n_in; ++j) {
      for (Eigen::Index l = 0; l <= j; ++l) {
        std::complex<double> sum = 0.0;
        for (Eigen::Index i = 0; i < n_out; ++i) sum += n(j, i) * std::conj(n(l, i));
        point.gram(j, l) = sum;
        if (l < j) point.gram(l, j) = std::conj(sum);
      }
    }
    point.spectrum = hermitian_spectrum(point.gram);
    auto& values = point.spectrum.values;
    const double top = std::max(values(0), 1e-300);
    double sum = 0.0;
    for (Eigen::Index k = 0; k < n_in; ++k) {
      values(k) = std::max(values(k), 0.0);
      point.weights(k) = k == 0 ? 1.0 : point.power == kExact ? 0.0 : std::pow(values(k) / top, point.power);
      sum += point.weights(k);
    }
    for (Eigen::Index k = 0; k < n_in; ++k) point.weights(k) /= sum;
    point.sigma2 = top;
    point.gap = n_in > 1 ? (top - values(1)) / top : 1.0;
    point.value = std::log(top) + (point.power == kExact ? 0.0 : std::log(sum) / point.power);
    for (Eigen::Index k = 0; k < n_in; ++k) {
      for (Eigen::Index i = 0; i < n_out; ++i) {
        std::complex<double> y = 0.0;
        for (Eigen::Index j = 0; j < n_in; ++j) y += std::conj(n(j, i)) * point.spectrum.vectors(j, k);
        point.right(i, k) = y;
      }
    }
  }

  // (λ_k^{p−1} − λ_l^{p−1}) / ((λ_k − λ_l) Σ λ^p) for k < l, λ_k ≥ λ_l.
  static double divided_difference(const Point& point, Eigen::Index k, Eigen::Index l) {
    const double first = point.spectrum.values(k), second = point.spectrum.values(l);
    const double weight = point.weights(k);  // λ_k^p / Σ
    if (!(weight > 0.0) || !(first > 0.0)) return 0.0;
    const double relative = (first - second) / first;
    if (point.power == kExact) return relative > 1e-15 ? weight / (first * first * relative) : 0.0;
    const double exponent = point.power - 1.0;
    if (relative < 1e-15) return weight * exponent / (first * first);
    return weight * -std::expm1(exponent * std::log1p(-std::min(relative, 1.0 - 1e-16))) / (first * first * relative);
  }

  Curvature spectral_curvature(const Point& point, InVector& g_in, OutVector& g_out) const {
    const Eigen::Index n_in = x_.rows(), n_out = x_.cols();
    const auto& u = point.spectrum.vectors;
    const auto& y = point.right;
    const auto& lambda = point.spectrum.values;
    const bool exact = point.power == kExact;
    const Eigen::Index terms = exact ? 1 : n_in;
    Curvature c;
    c.in.setZero(n_in, n_in);
    c.cross.setZero(n_in, n_out);
    c.out.setZero(n_out, n_out);
    const double spread = exact ? 0.0 : point.power;
    InVector e_in(n_in);
    OutVector e_out(n_out);
    for (Eigen::Index k = 0; k < terms; ++k) {
      const double weight = point.weights(k);
      if (!(weight > 1e-30) || !(lambda(k) > 0.0)) continue;
      const double inverse = 1.0 / lambda(k);
      for (Eigen::Index j = 0; j < n_in; ++j) e_in(j) = std::norm(u(j, k));
      for (Eigen::Index i = 0; i < n_out; ++i) e_out(i) = std::norm(y(i, k)) * inverse;
      // Own direction of the eigenvalue, and u_kᴴ G_ab u_k: ½ Re(conj(u_kj) G_jl u_kl) + ½ δ_jl λ |u_kj|² for α,
      // Re(conj(u_kj) N_ji y_ki) for α with β, δ |y_ki|² for β.
      const double own = exact ? -1.0 : spread - 1.0;
      for (Eigen::Index j = 0; j < n_in; ++j) {
        for (Eigen::Index l = 0; l <= j; ++l) {
          const double g = (std::conj(u(j, k)) * point.gram(j, l) * u(l, k)).real() * inverse;
          c.in(j, l) += weight * (own * e_in(j) * e_in(l) + 0.5 * g);
        }
        c.in(j, j) += weight * 0.5 * e_in(j);
        for (Eigen::Index i = 0; i < n_out; ++i) {
          const std::complex<double> n = (point.a(j) * point.b(i)) * x_(j, i);
          c.cross(j, i) += weight * (own * e_in(j) * e_out(i) + (std::conj(u(j, k)) * n * y(i, k)).real() * inverse);
        }
      }
      for (Eigen::Index i = 0; i < n_out; ++i) {
        for (Eigen::Index m = 0; m <= i; ++m) c.out(i, m) += weight * own * e_out(i) * e_out(m);
        c.out(i, i) += weight * e_out(i);
      }
      for (Eigen::Index j = 0; j < n_in; ++j) g_in(j) += weight * e_in(j);
      for (Eigen::Index i = 0; i < n_out; ++i) g_out(i) += weight * e_out(i);
    }
    Eigen::Matrix<std::complex<double>, In, 1> p_in(n_in);
    Eigen::Matrix<std::complex<double>, Out, 1> p_out(n_out);
    for (Eigen::Index k = 0; k < terms; ++k) {
      for (Eigen::Index l = k + 1; l < n_in; ++l) {
        const double factor = 2.0 * divided_difference(point, k, l);
        if (!(factor > 0.0)) continue;
        const double half = 0.5 * (lambda(k) + lambda(l));
        for (Eigen::Index j = 0; j < n_in; ++j) p_in(j) = half * (std::conj(u(j, k)) * u(j, l));
        for (Eigen::Index i = 0; i < n_out; ++i) p_out(i) = std::conj(y(i, k)) * y(i, l);
        add_outer(c, p_in, p_out, factor);
      }
    }
    if (!exact) {  // − p F_a F_b; for p = ∞ it has cancelled with p e e
      for (Eigen::Index j = 0; j < n_in; ++j) {
        for (Eigen::Index l = 0; l <= j; ++l) c.in(j, l) -= spread * g_in(j) * g_in(l);
        for (Eigen::Index i = 0; i < n_out; ++i) c.cross(j, i) -= spread * g_in(j) * g_out(i);
      }
      for (Eigen::Index i = 0; i < n_out; ++i) {
        for (Eigen::Index m = 0; m <= i; ++m) c.out(i, m) -= spread * g_out(i) * g_out(m);
      }
    }
    for (Eigen::Index j = 0; j < n_in; ++j) {
      for (Eigen::Index l = j + 1; l < n_in; ++l) c.in(j, l) = c.in(l, j);
    }
    for (Eigen::Index i = 0; i < n_out; ++i) {
      for (Eigen::Index m = i + 1; m < n_out; ++m) c.out(i, m) = c.out(m, i);
    }
    return c;
  }

  template <typename VIn, typename VOut>
  static void add_outer(Curvature& c, const VIn& p_in, const VOut& p_out, double factor) {
    const Eigen::Index n_in = p_in.size(), n_out = p_out.size();
    const auto product = [](std::complex<double> x, std::complex<double> y) {
      return x.real() * y.real() + x.imag() * y.imag();
    };
    for (Eigen::Index j = 0; j < n_in; ++j) {
      for (Eigen::Index l = 0; l <= j; ++l) c.in(j, l) += factor * product(p_in(j), p_in(l));
      for (Eigen::Index i = 0; i < n_out; ++i) c.cross(j, i) += factor * product(p_in(j), p_out(i));
    }
    for (Eigen::Index i = 0; i < n_out; ++i) {
      for (Eigen::Index m = 0; m <= i; ++m) c.out(i, m) += factor * product(p_out(i), p_out(m));
    }
  }

  // dα = Pᵀ ds + dt, dβ = −ds − Q dt with P = into, Q = out_of; the second derivatives of α and β are those of a
  // logarithm of a sum of exponentials.
  Derivatives chain(const Point& point, const InVector& g_in, const OutVector& g_out, const Curvature& c) const {
    const Eigen::Index n_in = x_.rows(), n_out = x_.cols();
    const auto& p = point.into;
    const auto& q = point.out_of;
    const Radii pa = p.lazyProduct(c.in);                                        // P A
    const Eigen::Matrix<double, Out, Out> pc = p.lazyProduct(c.cross);           // P C
    const Radii bq = c.out.lazyProduct(q);                                       // B Q
    const Eigen::Matrix<double, In, In> cq = c.cross.lazyProduct(q);             // C Q
    const OutVector p_g = p.lazyProduct(g_in);
    const InVector q_g = q.transpose().lazyProduct(g_out);
    Eigen::Matrix<double, Out, Out> ss = c.out - pc - pc.transpose();
    ss += (pa - p * g_in.asDiagonal()).lazyProduct(p.transpose());
    Radii st = pa - c.cross.transpose() + bq;
    st -= pc.lazyProduct(q);
    Eigen::Matrix<double, In, In> tt = c.in - cq - cq.transpose();
    tt += q.transpose().lazyProduct(bq - g_out.asDiagonal() * q);
    Derivatives d;
    d.gradient.resize(n_in + n_out - 2);
    d.hessian.resize(n_in + n_out - 2, n_in + n_out - 2);
    for (Eigen::Index i = 1; i < n_out; ++i) {
      d.gradient(i - 1) = p_g(i) - g_out(i);
      for (Eigen::Index m = 1; m < n_out; ++m) d.hessian(i - 1, m - 1) = ss(i, m) + (i == m ? p_g(i) : 0.0);
      for (Eigen::Index j = 1; j < n_in; ++j) {
        d.hessian(i - 1, n_out + j - 2) = d.hessian(n_out + j - 2, i - 1) = st(i, j);
      }
    }
    for (Eigen::Index j = 1; j < n_in; ++j) {
      d.gradient(n_out + j - 2) = g_in(j) - q_g(j);
      for (Eigen::Index l = 1; l < n_in; ++l) {
        d.hessian(n_out + j - 2, n_out + l - 2) = tt(j, l) + (j == l ? q_g(j) : 0.0);
      }
    }
    return d;
  }

  const Loop& x_;
  const Radii& w_;
};

}  // namespace fatmc
