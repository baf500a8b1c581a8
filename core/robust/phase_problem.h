// Lower bound of the structured singular value: the largest |λ| of A = X diag(p) W diag(q) over unit phases p (n_out)
// and q (n_in). Every eigenvalue of every such A is a lower bound.
//
// With the spectral projector Π of λ (Π = adj(λ I − A)/λ-polynomial's derivative in the 3 × 3 case),
//   ∂ log λ/∂φ_i = i c_i,  c_out = diag(P W Q Π X)/λ,  c_in = diag(Π),  Σ c_out = Σ c_in = 1,
// so that ∂ log|λ|/∂φ_i = −Im c_i. Turning every phase by −arg c_i is an ascent direction and its fixed point is the
// aligned vector of Packard and Doyle's power iteration. Near a maximum Newton steps with the exact Hessian take over:
// A_φi = i X_i r_i, A_χj = i A E_j (r_i row i of P W Q), and
//   ∂²λ = tr(Π A_ab) + tr(Π A_a R A_b) + tr(Π A_b R A_a),  R the reduced resolvent of A at λ.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>

namespace fatmc {

/// An eigenvalue with its projector and reduced resolvent.
template <int N>
struct EigenvalueExpansion {
  using Square = Eigen::Matrix<std::complex<double>, N, N>;
  std::complex<double> value;
  Square projector;
  Square resolvent;
  bool simple = false;  ///< false: (nearly) defective, the rest is meaningless
};

/// Of the eigenvalue of largest modulus, any size; what the 3 × 3 case is told about its place is not needed.
template <int N>
EigenvalueExpansion<N> expand_eigenvalue(const Eigen::Matrix<std::complex<double>, N, N>& a, std::complex<double>,
                                         bool) {
  EigenvalueExpansion<N> out;
  const Eigen::ComplexEigenSolver<Eigen::Matrix<std::complex<double>, N, N>> solver(a);
  Eigen::Index k = 0;
  solver.eigenvalues().cwiseAbs().maxCoeff(&k);
  out.value = solver.eigenvalues()(k);
  const Eigen::PartialPivLU<Eigen::Matrix<std::complex<double>, N, N>> lu(solver.eigenvectors());
  if (!(lu.rcond() > 1e-12)) return out;
  const auto inverse = lu.inverse().eval();
  out.projector = solver.eigenvectors().col(k) * inverse.row(k);
  out.resolvent = out.projector * 0.0;
  for (Eigen::Index l = 0; l < a.rows(); ++l) {
    if (l == k) continue;
    const std::complex<double> difference = out.value - solver.eigenvalues()(l);
    if (!(std::abs(difference) > 1e-12 * std::abs(out.value))) return out;
    out.resolvent += (1.0 / difference) * solver.eigenvectors().col(l) * inverse.row(l);
  }
  out.simple = true;
  return out;
}

/// The eigenvalue of a 3 × 3 matrix that Newton's method on the characteristic polynomial reaches from `near`, or, if
/// `largest`, the one of largest modulus (Cardano, then Newton).
inline EigenvalueExpansion<3> expand_eigenvalue(const Eigen::Matrix3cd& a, std::complex<double> near, bool largest) {
  using Complex = std::complex<double>;
  EigenvalueExpansion<3> out;
  const Complex trace = a(0, 0) + a(1, 1) + a(2, 2);
  const auto minor = [&a](int i, int j, int k, int l) { return a(i, k) * a(j, l) - a(i, l) * a(j, k); };
  const Complex second = minor(0, 1, 0, 1) + minor(0, 2, 0, 2) + minor(1, 2, 1, 2);
  const Complex det = a(0, 0) * minor(1, 2, 1, 2) - a(0, 1) * minor(1, 2, 0, 2) + a(0, 2) * minor(1, 2, 0, 1);
  Complex value = near;
  if (largest) {
    const Complex centre = trace / 3.0;
    const Complex p = second / 3.0 - centre * centre;
    const Complex q = centre * centre * centre - 0.5 * centre * second + 0.5 * det;
    const Complex root = std::sqrt(q * q + p * p * p);
    Complex cube = std::abs(q + root) >= std::abs(q - root) ? q + root : q - root;
    cube = std::abs(cube) > 0.0 ? std::pow(cube, 1.0 / 3.0) : Complex(0.0);
    const Complex turn(-0.5, 0.86602540378443865);
    double best = -1.0;
    for (int k = 0; k < 3; ++k) {
      const Complex root_k = centre + cube - (std::abs(cube) > 0.0 ? p / cube : Complex(0.0));
      if (std::norm(root_k) > best) {
        best = std::norm(root_k);
        value = root_k;
      }
      cube *= turn;
    }
  }
  bool converged = false;
  for (int k = 0; k < (largest ? 4 : 30) && !converged; ++k) {
    const Complex slope = (3.0 * value - 2.0 * trace) * value + second;
    const Complex step = (((value - trace) * value + second) * value - det) / slope;
    if (!(std::norm(slope) > 0.0)) return out;
    value -= step;
    converged = std::norm(step) < 1e-28 * std::norm(value);
  }
  if (!(std::isfinite(value.real()) && std::isfinite(value.imag()))) return out;
  out.value = value;
  Eigen::Matrix3cd b = -a;  // λ I − A
  for (int i = 0; i < 3; ++i) b(i, i) += value;
  const auto cofactor = [&b](int i, int j) {  // of b(i, j); indices taken modulo 3 carry the sign
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    return b(i1, j1) * b(i2, j2) - b(i1, j2) * b(i2, j1);
  };
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) out.projector(j, i) = cofactor(i, j);
  }
  const Complex slope = out.projector(0, 0) + out.projector(1, 1) + out.projector(2, 2);
  if (!(std::abs(slope) > 1e-12 * std::norm(value))) return out;
  out.projector /= slope;
  // On the complement of Π, λ − A is 2 × 2 with trace τ and determinant `slope`: inverse (τ − (λ − A))/slope.
  const Complex tau = 3.0 * value - trace;
  out.resolvent = -b;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) out.resolvent(i, j) = ((i == j ? tau : 0.0) - b(i, j) - tau * out.projector(i, j)) / slope;
  }
  out.simple = true;
  return out;
}

template <int In, int Out>
class PhaseProblem {
 public:
  static constexpr int kPhases = In == Eigen::Dynamic ? Eigen::Dynamic : In + Out;
  using Loop = Eigen::Matrix<std::complex<double>, In, Out>;
  using Radii = Eigen::Matrix<double, Out, In>;
  using Phases = Eigen::Matrix<double, kPhases, 1>;  ///< of p, then of q
  using Symmetric = Eigen::Matrix<double, kPhases, kPhases>;
  using InSquare = Eigen::Matrix<std::complex<double>, In, In>;

  struct Point {
    Phases phases;
    InSquare a;
    Eigen::Matrix<std::complex<double>, Out, In> perturbation;  ///< P W Q
    EigenvalueExpansion<In> eigen;
    double rho = 0.0;
  };

  PhaseProblem(const Loop& x, const Radii& radii) : x_(x), w_(radii) {}

  /// `near` is the eigenvalue to follow; with `largest` the one of largest modulus is sought.
  [[nodiscard]] Point evaluate(const Phases& phases, std::complex<double> near, bool largest) const {
    const Eigen::Index n_in = x_.rows(), n_out = x_.cols();
    Point point;
    point.phases = phases;
    point.perturbation.resize(n_out, n_in);
    Eigen::Matrix<std::complex<double>, In, 1> q(n_in);
    for (Eigen::Index j = 0; j < n_in; ++j) q(j) = std::polar(1.0, phases(n_out + j));
    for (Eigen::Index i = 0; i < n_out; ++i) {
      const std::complex<double> p = std::polar(1.0, phases(i));
      for (Eigen::Index j = 0; j < n_in; ++j) point.perturbation(i, j) = w_(i, j) * (p * q(j));
    }
    point.a = x_.lazyProduct(point.perturbation);
    point.eigen = expand_eigenvalue(point.a, near, largest);
    point.rho = std::abs(point.eigen.value);
    return point;
  }

  /// Climbs until the Newton decrement is below `tolerance` (relative change of ρ) or `steps` are spent.
  Point climb(Point point, double tolerance, int steps) const {
    for (int k = 0; k < steps && point.eigen.simple; ++k) {
      Phases direction;
      const double gain = ascent_step(point, direction);
      if (!(gain > tolerance)) break;
      bool moved = false;
      double step = 1.0;
      for (int trial = 0; trial < 8 && !moved; ++trial, step *= 0.4) {
        const Point next = evaluate(point.phases + step * direction, point.eigen.value, true);
        if (next.rho > point.rho * (1.0 + 1e-4 * step * gain)) {
          point = next;
          moved = true;
        }
      }
      if (!moved) break;
    }
    return point;
  }

 private:
  // The step to try, and the relative increase of ρ that its model promises.
  double ascent_step(const Point& point, Phases& direction) const {
    const Eigen::Index n_in = x_.rows(), n_out = x_.cols(), n = n_in + n_out;
    const std::complex<double> lambda = point.eigen.value;
    const auto& projector = point.eigen.projector;
    const auto& resolvent = point.eigen.resolvent;
    using Rectangle = Eigen::Matrix<std::complex<double>, Out, In>;
    const Rectangle dp = point.perturbation.lazyProduct(projector) / lambda;   // Δ Π / λ
    const Rectangle dr = point.perturbation.lazyProduct(resolvent);            // Δ R
    const Eigen::Matrix<std::complex<double>, Out, Out> pi_out = dp.lazyProduct(x_);   // Δ Π X / λ
    const Eigen::Matrix<std::complex<double>, Out, Out> r_out = dr.lazyProduct(x_);    // Δ R X
    const Loop pi_x = projector.lazyProduct(x_);                                       // Π X
    const Loop r_x = resolvent.lazyProduct(x_);                                        // R X
    Phases gradient(n);
    direction.resize(n);
    for (Eigen::Index i = 0; i < n_out; ++i) {
      gradient(i) = -pi_out(i, i).imag();
      direction(i) = -std::arg(pi_out(i, i));
    }
    for (Eigen::Index j = 0; j < n_in; ++j) {
      gradient(n_out + j) = -projector(j, j).imag();
      direction(n_out + j) = -std::arg(projector(j, j));
    }
    // −∂² log|λ|: with A_a = i B_a the three traces become those of B, with the sign turned once more for i².
    Symmetric curvature(n, n);
    const auto c = [&](Eigen::Index a) { return a < n_out ? pi_out(a, a) : projector(a - n_out, a - n_out); };
    for (Eigen::Index a = 0; a < n; ++a) {
      for (Eigen::Index b = 0; b <= a; ++b) {
        std::complex<double> second = -c(a) * c(b);
        if (a == b) second += c(a);
        if (a < n_out) {
          // tr(Π X_a r_a R X_b r_b) = (r_b Π X_a)(r_a R X_b)
          second += pi_out(b, a) * r_out(a, b) + pi_out(a, b) * r_out(b, a);
        } else if (b < n_out) {
          const Eigen::Index j = a - n_out;
          // A_ab = −X_b Δ_bj e_j; Π A E_j = λ Π E_j, R A = λ R + Π − I.
          second += point.perturbation(b, j) * pi_x(j, b) / lambda;
          // tr(Π A E_j R X_b r_b)/λ = (r_b Π)_j (R X_b)_j
          second += dp(b, j) * lambda * r_x(j, b);
          // tr(Π X_b r_b R A E_j)/λ = (Π X_b)_j (r_b R A)_j / λ
          second += pi_x(j, b) * (dr(b, j) + (dp(b, j) - point.perturbation(b, j) / lambda));
        } else {
          const Eigen::Index j = a - n_out, l = b - n_out;
          // tr(Π A E_j R A E_l)/λ = Π_lj (R A)_jl
          const std::complex<double> ra_jl = lambda * resolvent(j, l) + projector(j, l) - (j == l ? 1.0 : 0.0);
          const std::complex<double> ra_lj = lambda * resolvent(l, j) + projector(l, j) - (j == l ? 1.0 : 0.0);
          second += projector(l, j) * ra_jl + projector(j, l) * ra_lj;
        }
        curvature(a, b) = curvature(b, a) = second.real();
      }
    }
    return newton_or_alignment(curvature, gradient, direction);
  }

  // Newton where −Hessian is positive definite on the complement of the two directions that change nothing.
  double newton_or_alignment(Symmetric& curvature, const Phases& gradient, Phases& direction) const {
    const Eigen::Index n = gradient.size();
    // A common turn of all p, or of all q, leaves ρ: shift those directions to unit curvature.
    const Eigen::Index n_out = x_.cols();
    for (Eigen::Index a = 0; a < n; ++a) {
      for (Eigen::Index b = 0; b < n; ++b) {
        if ((a < n_out) == (b < n_out)) curvature(a, b) += 1.0;
      }
    }
    const Eigen::LLT<Symmetric> cholesky(curvature);
    if (cholesky.info() == Eigen::Success) {
      const Phases step = cholesky.solve(gradient);
      if (step.allFinite() && step.cwiseAbs().maxCoeff() < 1.5) {
        direction = step;
        return 0.5 * gradient.dot(step);
      }
    }
    return 0.5 * gradient.dot(direction);
  }

  const Loop& x_;
  const Radii& w_;
};

}  // namespace fatmc
