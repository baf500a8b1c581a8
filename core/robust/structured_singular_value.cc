#include "core/robust/structured_singular_value.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/robust/largest_singular_value.h"

namespace fatmc {

LoopMatrix loop_matrix(const Eigen::Ref<const Eigen::MatrixXcd>& plant,
                       const Eigen::Ref<const Eigen::MatrixXcd>& controller) {
  const Eigen::Index inputs = controller.rows();
  const Eigen::MatrixXcd difference = Eigen::MatrixXcd::Identity(inputs, inputs) + controller * plant;
  const Eigen::FullPivLU<Eigen::MatrixXcd> lu(difference);
  LoopMatrix out;
  out.invertible = difference.allFinite() && lu.isInvertible();
  out.x = out.invertible ? Eigen::MatrixXcd(lu.solve(controller)) : Eigen::MatrixXcd::Zero(inputs, controller.cols());
  return out;
}

namespace {

// The problem for n_in × n_out known at compile time (3 × 3) or not (Eigen::Dynamic). Variables are θ = (log s, log t)
// without the first of each, which fix the two scales that change nothing.
template <int In, int Out>
class SsvProblem {
 public:
  static constexpr int kVariables = In == Eigen::Dynamic ? Eigen::Dynamic : In + Out - 2;
  using Loop = Eigen::Matrix<std::complex<double>, In, Out>;
  using Radii = Eigen::Matrix<double, Out, In>;
  using InVector = Eigen::Matrix<double, In, 1>;
  using OutVector = Eigen::Matrix<double, Out, 1>;
  using Variables = Eigen::Matrix<double, kVariables, 1>;
  using Hessian = Eigen::Matrix<double, kVariables, kVariables>;
  using InGram = Eigen::Matrix<std::complex<double>, In, In>;
  using InPhases = Eigen::Matrix<std::complex<double>, In, 1>;
  using OutPhases = Eigen::Matrix<std::complex<double>, Out, 1>;

  struct Point {
    Variables theta;
    double value = 0.0;  // log of σ_max², or of its smooth majorant
    double sigma2 = 0.0;
    double gap = 0.0;
    Variables gradient;
    OutPhases v;  // right singular vector; n_out
    InPhases u;   // left singular vector; n_in
  };

  SsvProblem(const Loop& x, const Radii& radii) : x_(x), w_(radii) {}

  // log σ_max² and its gradient; with power > 0 the majorant log (Σ λ^power)^(1/power), smooth where λ1 is multiple.
  Point evaluate(const Variables& theta, double power = 0.0) {
    ++evaluations_;
    Point point;
    point.theta = theta;
    const Eigen::Index n_in = x_.rows(), n_out = x_.cols();
    OutVector s = OutVector::Ones(n_out);
    InVector t = InVector::Ones(n_in);
    s.tail(n_out - 1) = theta.head(n_out - 1).array().exp();
    t.tail(n_in - 1) = theta.tail(n_in - 1).array().exp();
    const InVector column = w_.transpose() * s;       // Σ_i w_ij s_i
    const OutVector row = w_ * t.cwiseInverse();      // Σ_j w_ij / t_j
    const InVector a = (t.array() * column.array()).sqrt();
    const OutVector b = (row.array() / s.array()).sqrt();
    const Loop n = a.asDiagonal() * x_ * b.asDiagonal();
    const InGram gram = n * n.adjoint();

    InVector left;    // Σ_k ω_k |u_k|²
    OutVector right;  // Σ_k ω_k |v_k|²
    if (power > 0.0) {
      const Eigen::SelfAdjointEigenSolver<InGram> solver(gram);
      const double top = std::max(solver.eigenvalues()(n_in - 1), 1e-300);
      InVector weight = (solver.eigenvalues().array().max(0.0) / top).pow(power);
      const double sum = weight.sum();
      point.sigma2 = top;
      point.value = std::log(top) + std::log(sum) / power;
      weight /= sum;
      left = solver.eigenvectors().cwiseAbs2() * weight;
      right.setZero(n_out);
      for (Eigen::Index k = 0; k < n_in; ++k) {
        const double lambda = solver.eigenvalues()(k);
        if (lambda > 1e-300) right += (weight(k) / lambda) * (n.adjoint() * solver.eigenvectors().col(k)).cwiseAbs2();
      }
      point.u = solver.eigenvectors().col(n_in - 1);
      point.gap = n_in > 1 ? (top - solver.eigenvalues()(n_in - 2)) / top : 1.0;
    } else {
      const LargestEigenpair<In> largest = largest_eigenpair(gram);
      point.sigma2 = std::max(largest.value, 1e-300);
      point.value = std::log(point.sigma2);
      point.u = largest.vector;
      point.gap = largest.gap;
      left = point.u.cwiseAbs2();
      right = (n.adjoint() * point.u).cwiseAbs2() / point.sigma2;
    }
    point.v = n.adjoint() * point.u / std::sqrt(point.sigma2);

    // d log σ² = Σ_j left_j d log a_j² + Σ_i right_i d log b_i².
    point.gradient.resize(n_in + n_out - 2);
    for (Eigen::Index i = 1; i < n_out; ++i) {
      double sum = 0.0;
      for (Eigen::Index j = 0; j < n_in; ++j) {
        if (column(j) > 0.0) sum += left(j) * w_(i, j) * s(i) / column(j);
      }
      point.gradient(i - 1) = sum - (row(i) > 0.0 ? right(i) : 0.0);
    }
    for (Eigen::Index j = 1; j < n_in; ++j) {
      double sum = 0.0;
      for (Eigen::Index i = 0; i < n_out; ++i) {
        if (row(i) > 0.0) sum += right(i) * w_(i, j) / (t(j) * row(i));
      }
      point.gradient(n_out - 1 + j - 1) = (column(j) > 0.0 ? left(j) : 0.0) - sum;
    }
    return point;
  }

  // Quasi-Newton descent (BFGS, backtracking); θ is bounded because a zero pattern of w may send it to infinity.
  Point descend(Point point, double power, const SsvOptions& options) {
    const Eigen::Index variables = point.theta.size();
    Hessian inverse = Hessian::Identity(variables, variables) * 2.0;
    bool scaled = false;
    while (evaluations_ < options.max_iterations) {
      Variables direction = -(inverse * point.gradient);
      double slope = direction.dot(point.gradient);
      if (!(slope < 0.0)) {
        inverse = Hessian::Identity(variables, variables);
        direction = -point.gradient;
        slope = direction.dot(point.gradient);
        if (!(slope < -1e-30)) break;
      }
      // The quadratic model promises a decrease of -slope/2.
      if (-slope < options.tolerance) break;
      const double longest = direction.cwiseAbs().maxCoeff();
      if (longest > 4.0) {
        direction *= 4.0 / longest;
        slope *= 4.0 / longest;
      }
      double step = 1.0;
      Point next = evaluate(clamp(point.theta + direction), power);
      while (next.value > point.value + 1e-4 * step * slope && step > 1e-6 && evaluations_ < options.max_iterations) {
        // Minimum of the parabola through both values and the slope, kept within a sensible part of the step.
        const double curvature = next.value - point.value - step * slope;
        step *= std::clamp(-0.5 * step * slope / curvature, 0.1, 0.5);
        next = evaluate(clamp(point.theta + step * direction), power);
      }
      if (!(next.value < point.value)) break;
      const Variables dx = next.theta - point.theta;
      const Variables dg = next.gradient - point.gradient;
      const double product = dx.dot(dg);
      if (product > 1e-14 * dx.norm() * dg.norm()) {
        if (!scaled) {
          inverse *= product / (2.0 * dg.squaredNorm());
          scaled = true;
        }
        const Variables hg = inverse * dg;
        inverse += ((product + dg.dot(hg)) / (product * product)) * dx * dx.transpose() -
                   (hg * dx.transpose() + dx * hg.transpose()) / product;
      }
      point = next;
    }
    return point;
  }

  // ρ(X diag(p) W diag(q)) climbed from the phases of a pair of singular vectors: with the eigenvector x of the
  // current phases, y = W |x| aligned; a power method on x ← X (phases) W |x|.
  double lower_bound(const OutPhases& v, const InPhases& u, int iterations) const {
    const Eigen::Index n_in = x_.rows(), n_out = x_.cols();
    OutPhases p(n_out);
    InPhases q(n_in);
    for (Eigen::Index i = 0; i < n_out; ++i) p(i) = phase(v(i));
    for (Eigen::Index j = 0; j < n_in; ++j) q(j) = std::conj(phase(u(j)));
    double best = spectral_radius(p, q);
    for (int k = 0; k < iterations; ++k) {
      // Ascent: right and left eigenvectors of A = X diag(p) W diag(q) say how each phase should turn.
      if (!turn_phases(p, q)) break;
      const double next = spectral_radius(p, q);
      if (next <= best * (1.0 + 1e-12)) {
        best = std::max(best, next);
        break;
      }
      best = next;
    }
    return best;
  }

  [[nodiscard]] int evaluations() const { return evaluations_; }

 private:
  static std::complex<double> phase(std::complex<double> z) {
    const double magnitude = std::abs(z);
    return magnitude > 1e-150 ? z / magnitude : std::complex<double>(1.0);
  }
  static Variables clamp(const Variables& theta) { return theta.cwiseMax(-60.0).cwiseMin(60.0); }

  InGram product(const OutPhases& p, const InPhases& q) const {
    return x_ * p.asDiagonal() * w_.template cast<std::complex<double>>() * q.asDiagonal();
  }
  double spectral_radius(const OutPhases& p, const InPhases& q) const {
    const Eigen::ComplexEigenSolver<InGram> solver(product(p, q), false);
    return solver.eigenvalues().cwiseAbs().maxCoeff();
  }
  // One alignment step. At a maximum of ρ over the phases, with A x = λ x and zᴴ A = λ zᴴ (zᴴ x real positive after a
  // common turn), the contributions of every output, (zᴴ X)_i p_i (W diag(q) x)_i, and of every input have the phase of
  // λ zᴴ x; the step turns p and q so that they do.
  bool turn_phases(OutPhases& p, InPhases& q) const {
    const InGram a = product(p, q);
    const Eigen::ComplexEigenSolver<InGram> solver(a);
    Eigen::Index largest = 0;
    solver.eigenvalues().cwiseAbs().maxCoeff(&largest);
    const InPhases x = solver.eigenvectors().col(largest);
    const Eigen::FullPivLU<InGram> lu(solver.eigenvectors());
    if (!lu.isInvertible()) return false;
    const InGram inverse = lu.inverse();
    const Eigen::Matrix<std::complex<double>, 1, In> z = inverse.row(largest);  // z x = 1
    const std::complex<double> target = phase(solver.eigenvalues()(largest));
    const Eigen::Matrix<std::complex<double>, 1, Out> zx = z * x_;
    const InPhases qx = q.asDiagonal() * x;
    const OutPhases wqx = w_.template cast<std::complex<double>>() * qx;
    for (Eigen::Index i = 0; i < p.size(); ++i) {
      const std::complex<double> part = zx(i) * wqx(i);
      if (std::abs(part) > 1e-150) p(i) = target / phase(part);
    }
    const Eigen::Matrix<std::complex<double>, 1, In> zxpw =
        zx * p.asDiagonal() * w_.template cast<std::complex<double>>();
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      const std::complex<double> part = zxpw(j) * x(j);
      if (std::abs(part) > 1e-150) q(j) = target / phase(part);
    }
    return true;
  }

  const Loop& x_;
  const Radii& w_;
  int evaluations_ = 0;
};

template <int In, int Out>
SsvBounds solve(const Eigen::Ref<const Eigen::MatrixXcd>& x_in, const Eigen::Ref<const Eigen::MatrixXd>& radii_in,
                const SsvOptions& options, SsvScaling* scaling) {
  using Problem = SsvProblem<In, Out>;
  SsvBounds out;
  // Scaled to order one, so that tolerances are relative and nothing under- or overflows.
  const double x_scale = x_in.cwiseAbs().maxCoeff();
  const double w_scale = radii_in.maxCoeff();
  if (x_scale == 0.0 || w_scale == 0.0) {
    out.certified = true;
    return out;
  }
  const typename Problem::Loop x = x_in / x_scale;
  const typename Problem::Radii radii = radii_in / w_scale;
  const double scale = x_scale * w_scale;
  Problem problem(x, radii);

  const Eigen::Index n_in = x.rows(), n_out = x.cols();
  typename Problem::Variables theta = Problem::Variables::Zero(n_in + n_out - 2);
  if (scaling != nullptr && scaling->log_s.size() == n_out && scaling->log_t.size() == n_in) {
    theta.head(n_out - 1) = scaling->log_s.tail(n_out - 1);
    theta.tail(n_in - 1) = scaling->log_t.tail(n_in - 1);
  }
  typename Problem::Point point = problem.descend(problem.evaluate(theta), 0.0, options);
  out.lower = problem.lower_bound(point.v, point.u, 0);
  const auto upper = [&] { return std::sqrt(point.sigma2); };
  if (upper() - out.lower > options.agreement * upper()) {
    out.lower = std::max(out.lower, problem.lower_bound(point.v, point.u, options.phase_iterations));
  }
  if (upper() - out.lower > options.agreement * upper()) {
    // σ_max multiple at the optimum: follow smooth majorants towards it, then look from their singular vectors.
    for (double power = 8.0; power < 3e4 && problem.evaluations() < options.max_iterations; power *= 4.0) {
      const typename Problem::Point smooth = problem.descend(problem.evaluate(point.theta, power), power, options);
      if (smooth.sigma2 < point.sigma2) point = smooth;
      out.lower = std::max(out.lower, problem.lower_bound(smooth.v, smooth.u, options.phase_iterations));
    }
  }
  out.upper = upper() * scale;
  out.lower = std::min(out.lower, upper()) * scale;  // ρ is computed to round-off only
  out.certified = out.upper - out.lower <= options.agreement * out.upper;
  out.iterations = problem.evaluations();
  out.gradient = point.gradient.size() > 0 ? point.gradient.cwiseAbs().maxCoeff() : 0.0;
  if (scaling != nullptr) {
    scaling->log_s.setZero(n_out);
    scaling->log_t.setZero(n_in);
    scaling->log_s.tail(n_out - 1) = point.theta.head(n_out - 1);
    scaling->log_t.tail(n_in - 1) = point.theta.tail(n_in - 1);
  }
  return out;
}

}  // namespace

double h_infinity_value(const Eigen::Ref<const Eigen::MatrixXcd>& x, const Eigen::Ref<const Eigen::MatrixXd>& radii) {
  FATMC_CHECK(radii.rows() == x.cols() && radii.cols() == x.rows(), "radii are n_out by n_in");
  // D = I: a_j² = Σ_i w_ij², b_i² = n_in.
  const Eigen::VectorXd a = radii.colwise().norm().transpose();
  const Eigen::MatrixXcd n = a.asDiagonal() * x * std::sqrt(static_cast<double>(x.rows()));
  return std::sqrt(std::max(0.0, largest_eigenpair_dense<Eigen::Dynamic>(n * n.adjoint()).value));
}

SsvBounds structured_singular_value(const Eigen::Ref<const Eigen::MatrixXcd>& x,
                                    const Eigen::Ref<const Eigen::MatrixXd>& radii, const SsvOptions& options,
                                    SsvScaling* scaling) {
  FATMC_CHECK(radii.rows() == x.cols() && radii.cols() == x.rows(), "radii are n_out by n_in");
  FATMC_CHECK(x.allFinite() && radii.allFinite() && radii.minCoeff() >= 0.0, "finite loop, radii not negative");
  if (x.rows() == 3 && x.cols() == 3) return solve<3, 3>(x, radii, options, scaling);
  return solve<Eigen::Dynamic, Eigen::Dynamic>(x, radii, options, scaling);
}

}  // namespace fatmc
