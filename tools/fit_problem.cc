#include "tools/fit_problem.h"

#include <algorithm>
#include <cmath>

namespace fatmc::fit {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Parameters are in units of their priors' spreads from here on.
Vector values_at(const ValueProblem& problem, const Vector& x) {
  Vector out(x.size());
  for (std::size_t i = 0; i < problem.priors.size(); ++i) {
    const Prior& p = problem.priors[i];
    out[static_cast<Eigen::Index>(i)] = p.value + p.spread * x[static_cast<Eigen::Index>(i)];
  }
  return out;
}

Aircraft aircraft_with(const Problem& problem, const Vector& values) {
  Aircraft out = problem.start;
  for (std::size_t i = 0; i < problem.parameters.size(); ++i)
    problem.parameters[i].of(out) = values[static_cast<Eigen::Index>(i)];
  return out;
}

/// Residuals of all targets.
Vector residuals(const ValueProblem& problem, const Vector& x) {
  Vector out = problem.model(values_at(problem, x));
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    const Target& target = problem.targets[static_cast<std::size_t>(i)];
    out[i] = (out[i] - target.value) / target.tolerance;
  }
  return out;
}

/// Central differences, extrapolated once: error of fourth order.
Matrix jacobian(const ValueProblem& problem, const Vector& x) {
  constexpr double h = 1e-3;
  Matrix out(problem.targets.size(), x.size());
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    const auto difference = [&](double step) {
      Vector up = x;
      Vector down = x;
      up[j] += step;
      down[j] -= step;
      return Vector((residuals(problem, up) - residuals(problem, down)) / (2.0 * step));
    };
    out.col(j) = (4.0 * difference(0.5 * h) - difference(h)) / 3.0;
  }
  return out;
}

/// Levenberg-Marquardt on targets and priors, exact targets weighted as `1/loosening`, until a step is below
/// 1e-2.
void approach(const ValueProblem& problem, double loosening, Vector& x, ValueFit& fit) {
  constexpr int most_iterations = 100;
  Vector weight(problem.targets.size());
  for (std::size_t i = 0; i < problem.targets.size(); ++i) {
    weight[static_cast<Eigen::Index>(i)] = problem.targets[i].exact ? 1.0 / loosening : 1.0;
  }
  const auto weighted = [&](const Vector& at) {
    Vector out(weight.size() + at.size());
    out << residuals(problem, at).cwiseProduct(weight), at;
    return out;
  };
  Vector r = weighted(x);
  double damping = 1e-2;
  fit.step = 1.0;
  for (int iteration = 0; iteration < most_iterations && fit.step > 1e-2; ++iteration) {
    ++fit.iterations;
    Matrix j(r.size(), x.size());
    j << weight.asDiagonal() * jacobian(problem, x), Matrix::Identity(x.size(), x.size());
    bool better = false;
    for (int trial = 0; trial < 30 && !better; ++trial) {
      // min |J s + r|^2 + damping |D s|^2, D the norms of the columns, by QR of the stacked system
      Matrix stacked(j.rows() + j.cols(), j.cols());
      stacked << j, Matrix((std::sqrt(damping) * j.colwise().norm().transpose()).asDiagonal());
      Vector right = Vector::Zero(stacked.rows());
      right.head(r.size()) = -r;
      const Vector step = stacked.colPivHouseholderQr().solve(right);
      const Vector candidate = weighted(x + step);
      fit.step = step.cwiseAbs().maxCoeff();
      better = candidate.allFinite() && candidate.squaredNorm() < r.squaredNorm();
      if (better) {
        x += step;
        r = candidate;
      }
      damping = std::max(damping * (better ? 0.1 : 10.0), 1e-18);
    }
    if (!better) return;
  }
}

/// Second derivatives of a scalar function by central differences.
template <typename F>
Matrix hessian(const F& f, const Vector& x) {
  constexpr double h = 1e-2;
  Matrix out(x.size(), x.size());
  const auto at = [&](Eigen::Index i, double di, Eigen::Index j, double dj) {
    Vector moved = x;
    moved[i] += di;
    moved[j] += dj;
    return f(moved);
  };
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      out(i, j) = out(j, i) =
          (at(i, h, j, h) - at(i, h, j, -h) - at(i, -h, j, h) + at(i, -h, j, -h)) / (4.0 * h * h);
    }
  }
  return out;
}

/// Newton's method on L = 1/2 |x|^2 + 1/2 |soft|^2 + lambda' exact:
///   [H A'; A 0] [dx; lambda] = -[gradient; exact],  A = d(exact)/dx,  H = second derivatives of L.
void finish(const ValueProblem& problem, Vector& x, ValueFit& fit) {
  constexpr int most_iterations = 30;
  constexpr double small_step = 1e-6;  // spreads; the noise of the differences is about 3e-7
  std::vector<Eigen::Index> exact;
  std::vector<Eigen::Index> soft;
  for (std::size_t i = 0; i < problem.targets.size(); ++i) {
    (problem.targets[i].exact ? exact : soft).push_back(static_cast<Eigen::Index>(i));
  }
  const Eigen::Index n = x.size();
  const auto m = static_cast<Eigen::Index>(exact.size());
  Vector multiplier = Vector::Zero(m);
  Matrix curvature;
  for (int iteration = 0; iteration < most_iterations && !fit.converged; ++iteration) {
    ++fit.iterations;
    const Vector r = residuals(problem, x);
    const Matrix j = jacobian(problem, x);
    const Matrix a = j(exact, Eigen::all);
    const Vector gradient = x + Matrix(j(soft, Eigen::all)).transpose() * Vector(r(soft));
    if (iteration == 0 && m > 0) multiplier = a.transpose().colPivHouseholderQr().solve(-gradient);
    const auto curved = [&](const Vector& at) {
      const Vector all = residuals(problem, at);
      return 0.5 * Vector(all(soft)).squaredNorm() + multiplier.dot(Vector(all(exact)));
    };
    Matrix system = Matrix::Zero(n + m, n + m);
    if (iteration == 0 || fit.step > 1e-3) curvature = hessian(curved, x);  // near the end it changes no more
    system.topLeftCorner(n, n) = Matrix::Identity(n, n) + curvature;
    system.topRightCorner(n, m) = a.transpose();
    system.bottomLeftCorner(m, n) = a;
    Vector right(n + m);
    right << -gradient, -Vector(r(exact));
    const Vector solution = system.fullPivLu().solve(right);
    Vector step = solution.head(n);
    fit.step = step.cwiseAbs().maxCoeff();
    if (!std::isfinite(fit.step)) return;
    x += step * std::min(1.0, 0.5 / fit.step);
    multiplier = solution.tail(m);
    fit.converged = fit.step < small_step;
  }
  fit.violation = m > 0 ? Vector(residuals(problem, x)(exact)).lpNorm<Eigen::Infinity>() : 0.0;
}

}  // namespace

ValueFit solve(const ValueProblem& problem) {
  Vector x = Vector::Zero(static_cast<Eigen::Index>(problem.priors.size()));
  ValueFit fit;
  for (const double loosening : {1e4, 1e3, 1e2, 1e1}) approach(problem, loosening, x, fit);
  finish(problem, x, fit);
  fit.values = values_at(problem, x);
  fit.reached = problem.model(fit.values);
  return fit;
}

Fit solve(const Problem& problem) {
  ValueProblem values;
  for (const Parameter& p : problem.parameters) values.priors.push_back({p.name, p.prior, p.spread});
  values.targets = problem.targets;
  values.model = [&](const Vector& at) { return problem.model(aircraft_with(problem, at)); };
  Fit fit{solve(values), {}};
  fit.aircraft = aircraft_with(problem, fit.values);
  return fit;
}

}  // namespace fatmc::fit
