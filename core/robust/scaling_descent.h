// Newton descent of the scaling problem: first on log σ_max² itself, then, where σ_max is multiple at the optimum, along
// its smooth majorants.
#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/robust/scaling_problem.h"

namespace fatmc {

/// What a descent ended with.
template <int In, int Out>
struct Descent {
  typename ScalingProblem<In, Out>::Point best;
  double decrement = 0.0;  ///< ½ gᵀ H⁻¹ g before the last step: the decrease of F that it promised
  int evaluations = 0;
  bool converged = false;
};

/// Solves (H + ridge max H_ii) d = −g, the ridge raised where H is not positive definite to working precision: H is
/// positive semidefinite, singular along scalings that change nothing.
template <typename Hessian, typename Vector>
Vector newton_direction(const Hessian& h, const Vector& g, double ridge) {
  const Eigen::Index n = g.size();
  double largest = 1e-300;
  for (Eigen::Index i = 0; i < n; ++i) largest = std::max(largest, h(i, i));
  ridge *= largest;
  Vector d = Vector::Zero(n);
  for (int attempt = 0; attempt < 12; ++attempt, ridge *= 30.0) {
    Hessian l = h;
    bool positive = true;
    for (Eigen::Index j = 0; j < n && positive; ++j) {
      double pivot = l(j, j) + ridge;
      for (Eigen::Index k = 0; k < j; ++k) pivot -= l(j, k) * l(j, k);
      positive = pivot > 0.1 * ridge;
      if (!positive) break;
      const double root = std::sqrt(pivot);
      l(j, j) = root;
      for (Eigen::Index i = j + 1; i < n; ++i) {
        double sum = l(i, j);
        for (Eigen::Index k = 0; k < j; ++k) sum -= l(i, k) * l(j, k);
        l(i, j) = sum / root;
      }
    }
    if (!positive) continue;
    for (Eigen::Index i = 0; i < n; ++i) {
      double sum = -g(i);
      for (Eigen::Index k = 0; k < i; ++k) sum -= l(i, k) * d(k);
      d(i) = sum / l(i, i);
    }
    for (Eigen::Index i = n - 1; i >= 0; --i) {
      double sum = d(i);
      for (Eigen::Index k = i + 1; k < n; ++k) sum -= l(k, i) * d(k);
      d(i) = sum / l(i, i);
    }
    return d;
  }
  return -g / largest;
}

/// Damped Newton at one power. Stops when the decrement falls below `tolerance` (the step is still taken: convergence
/// is quadratic, the error left is of the order of its square), when no step decreases F, or after `limit` evaluations.
template <int In, int Out>
Descent<In, Out> descend(const ScalingProblem<In, Out>& problem, typename ScalingProblem<In, Out>::Point start,
                         double tolerance, int limit) {
  using Problem = ScalingProblem<In, Out>;
  Descent<In, Out> out;
  out.best = std::move(start);
  while (out.evaluations < limit) {
    const typename Problem::Derivatives d = problem.differentiate(out.best);
    // A step beyond e³ leaves the model's range: shorten it by a ridge first, which bends it towards the gradient.
    constexpr double kLongest = 3.0;
    typename Problem::Variables direction;
    double longest = 0.0;
    for (double ridge = 1e-12; ridge < 2.0; ridge *= 100.0) {
      direction = newton_direction(d.hessian, d.gradient, ridge);
      longest = 0.0;
      for (Eigen::Index i = 0; i < direction.size(); ++i) longest = std::max(longest, std::abs(direction(i)));
      if (longest <= kLongest) break;
    }
    const double slope = direction.dot(d.gradient);
    out.decrement = -0.5 * slope;
    if (!(out.decrement > 1e-16)) {
      out.converged = true;
      break;
    }
    double step = longest > kLongest ? kLongest / longest : 1.0;
    bool moved = false;
    while (!moved && step > 1e-3 && out.evaluations < limit) {
      typename Problem::Point next = problem.evaluate(out.best.theta + step * direction, out.best.power);
      ++out.evaluations;
      // Round-off of F allowed for: near the optimum the promised decrease is smaller than that.
      if (next.value <= out.best.value + 1e-4 * step * slope + 4e-16) {
        moved = true;
        out.best = std::move(next);
      } else if (out.best.power == Problem::kExact && std::min(next.gap, out.best.gap) < 0.02) {
        return out;  // crossing singular values: the smooth majorants are the better way
      } else {
        const double curvature = next.value - out.best.value - step * slope;
        step *= std::clamp(-0.5 * step * slope / curvature, 0.1, 0.5);
      }
    }
    if (out.decrement < tolerance) {
      out.converged = true;
      break;
    }
    if (!moved) break;
  }
  return out;
}

}  // namespace fatmc
