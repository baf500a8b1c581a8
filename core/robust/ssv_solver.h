// Solver behind structured_singular_value.h, for sizes fixed at compile time or Eigen::Dynamic. Each size is instantiated
// in a source file of its own: together they took over a minute to compile.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>

#include "core/robust/phase_problem.h"
#include "core/robust/scaling_descent.h"
#include "core/robust/scaling_problem.h"
#include "core/robust/structured_singular_value.h"

namespace fatmc::ssv {

using Complex = std::complex<double>;

// Keeps only what lies on a loop of the graph (input j → output i where w_ij > 0, output i → input j where x_ji ≠ 0).
// det(I + X Δ) depends on nothing else, and without it the best scalings would lie at infinity.
template <typename Loop, typename Radii>
void keep_loops(Loop& x, Radii& w) {
  const Eigen::Index n_in = x.rows(), n_out = x.cols(), n = n_in + n_out;
  if (w.minCoeff() > 0.0 && x.cwiseAbs2().minCoeff() > 0.0) return;
  Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> reaches(n, n);  // inputs, then outputs
  reaches.setConstant(false);
  for (Eigen::Index j = 0; j < n_in; ++j) {
    for (Eigen::Index i = 0; i < n_out; ++i) {
      reaches(j, n_in + i) = w(i, j) > 0.0;
      reaches(n_in + i, j) = x(j, i) != Complex(0.0);
    }
  }
  for (Eigen::Index k = 0; k < n; ++k) {
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) reaches(i, j) = reaches(i, j) || (reaches(i, k) && reaches(k, j));
    }
  }
  for (Eigen::Index j = 0; j < n_in; ++j) {
    for (Eigen::Index i = 0; i < n_out; ++i) {
      const bool loop = reaches(j, n_in + i) && reaches(n_in + i, j);
      if (!loop) w(i, j) = 0.0;
      if (!loop) x(j, i) = 0.0;
    }
  }
}

// Cold start: the optimum of the non-negative loop |X|. With Perron vectors x, z of |X| W (right, left) it is
// s = zᵀ|X|, t = 1/x; it moves with the units of the channels, so that bad units cost nothing, and is often close.
template <int In, int Out>
void perron_start(const typename ScalingProblem<In, Out>::Loop& x, const typename ScalingProblem<In, Out>::Radii& w,
                  typename ScalingProblem<In, Out>::Variables& theta) {
  const Eigen::Index n_in = x.rows(), n_out = x.cols();
  Eigen::Matrix<double, In, Out> size(n_in, n_out);
  for (Eigen::Index i = 0; i < n_out; ++i) {
    for (Eigen::Index j = 0; j < n_in; ++j) size(j, i) = std::sqrt(std::norm(x(j, i)));
  }
  Eigen::Matrix<double, In, In> power = size.lazyProduct(w), next(n_in, n_in);
  for (int k = 0; k < 4; ++k) {  // 16th power
    double largest = 1e-300;
    for (Eigen::Index j = 0; j < n_in; ++j) {
      for (Eigen::Index l = 0; l < n_in; ++l) largest = std::max(largest, power(j, l));
    }
    power *= 1.0 / largest;
    next = power.lazyProduct(power);
    power = next;
  }
  Eigen::Matrix<double, In, 1> right(n_in), left(n_in);
  for (Eigen::Index j = 0; j < n_in; ++j) {
    right(j) = left(j) = 0.0;
    for (Eigen::Index l = 0; l < n_in; ++l) {
      right(j) += power(j, l);
      left(j) += power(l, j);
    }
  }
  const auto log_of = [](double value) { return std::log(std::max(value, 1e-100)); };
  double first = 0.0;
  for (Eigen::Index i = 0; i < n_out; ++i) {
    double s = 0.0;
    for (Eigen::Index j = 0; j < n_in; ++j) s += left(j) * size(j, i);
    if (i == 0) first = log_of(s);
    else theta(i - 1) = log_of(s) - first;
  }
  first = log_of(right(0));
  for (Eigen::Index j = 1; j < n_in; ++j) theta(n_out + j - 2) = first - log_of(right(j));
}

template <int In, int Out>
class Solver {
 public:
  using Scalings = ScalingProblem<In, Out>;
  using PhaseSearch = PhaseProblem<In, Out>;

  Solver(const typename Scalings::Loop& x, const typename Scalings::Radii& w, const SsvOptions& options)
      : x_(x), w_(w), scalings_(x_, w_), phases_(x_, w_), options_(options) {}

  /// `theta` is the start and becomes the best scaling; `worst` becomes the phases behind the lower bound.
  SsvBounds solve(typename Scalings::Variables& theta, typename PhaseSearch::Phases& worst) {
    SsvBounds out;
    descend_exactly(theta, out);
    if (!met()) follow_majorants(theta, out);
    out.upper = std::sqrt(best_);
    out.lower = std::min(lower_, out.upper);  // ρ is known to round-off only
    out.status = met() ? SsvStatus::met : out.excess <= options_.agreement ? SsvStatus::gap : SsvStatus::not_converged;
    if (out.status == SsvStatus::met) out.excess = std::min(out.excess, (out.upper - out.lower) / out.upper);
    worst = worst_;
    return out;
  }

 private:
  [[nodiscard]] bool met() const {
    return std::sqrt(best_) - lower_ <= options_.agreement * std::sqrt(best_);
  }

  // The phases of Σ_k ω_k^½ e^{iψ_k} (u_k, v_k) as a start; σ_max is close to the eigenvalue.
  void look(const typename Scalings::Point& point, int climb_steps, double turn, SsvBounds& out) {
    const Eigen::Index n_in = x_.rows(), n_out = x_.cols();
    typename PhaseSearch::Phases phases(n_in + n_out);
    std::array<Complex, 2> mix{1.0, 0.0};
    if (climb_steps > 0 && n_in > 1) {
      mix[0] = std::sqrt(point.weights(0));
      mix[1] = std::polar(std::sqrt(point.weights(1)), turn);
    }
    const Eigen::Index terms = n_in > 1 ? 2 : 1;
    for (Eigen::Index i = 0; i < n_out; ++i) {
      Complex v = 0.0;
      for (Eigen::Index k = 0; k < terms; ++k) v += mix[static_cast<std::size_t>(k)] * point.right(i, k);
      phases(i) = std::arg(v);
    }
    for (Eigen::Index j = 0; j < n_in; ++j) {
      Complex u = 0.0;
      for (Eigen::Index k = 0; k < terms; ++k) u += mix[static_cast<std::size_t>(k)] * point.spectrum.vectors(j, k);
      phases(n_out + j) = -std::arg(u);
    }
    auto found = phases_.evaluate(phases, std::sqrt(point.sigma2), climb_steps > 0);
    if (climb_steps > 0) {
      ++out.climbs;
      found = phases_.climb(std::move(found), 1e-13, climb_steps);
    }
    if (!std::isfinite(found.rho)) return;
    if (found.rho > lower_ * (1.0 + 1e-9)) lower_found_ = 0;
    if (found.rho > lower_ * (1.0 - 1e-9)) ++lower_found_;
    if (found.rho > lower_) {
      lower_ = found.rho;
      worst_ = found.phases;
    }
  }

  // Newton on log σ_max² itself, and the lower bound from its singular vectors.
  void descend_exactly(typename Scalings::Variables& theta, SsvBounds& out) {
    typename Scalings::Point start = scalings_.evaluate(theta, Scalings::kExact);
    Descent<In, Out> descent = descend(scalings_, std::move(start), 1e-9, kExactEvaluations);
    out.iterations += descent.evaluations + 1;
    if (descent.best.sigma2 <= best_) {
      best_ = descent.best.sigma2;
      theta = descent.best.theta;
      // Quadratic convergence: the last step left the square of what it promised.
      out.excess = descent.converged && descent.best.gap > 1e-6 ? 0.5 * descent.decrement * descent.decrement : 1.0;
    }
    look(descent.best, 0, 0.0, out);
  }

  // σ_max multiple at the optimum, or met on the way there: minimisers of F_p for growing p. In μ = 1/p they lie on a
  // smooth curve, so that each stage starts from the line through the last two. min F_p − log(n) μ is below the minimum
  // of log σ_max²: the last μ bounds the distance to it.
  void follow_majorants(typename Scalings::Variables& theta, SsvBounds& out) {
    const double inputs = static_cast<double>(x_.rows());
    typename Scalings::Variables last = theta, before = theta, start = theta;
    double mu_last = 0.0, mu_before = 0.0, factor = 8.0, mu = 1.0 / 16.0;
    typename Scalings::Point point;
    bool any = false;
    while (mu > 1e-11 && out.iterations < options_.max_iterations) {
      Descent<In, Out> stage = descend(scalings_, scalings_.evaluate(start, 1.0 / mu), 1e-4 * mu,
                                       any ? kStageEvaluations : 80);
      out.iterations += stage.evaluations + 1;
      if (stage.best.sigma2 < best_) {
        best_ = stage.best.sigma2;
        theta = stage.best.theta;
      }
      if (!stage.converged) {  // shorter step along the curve
        factor = std::sqrt(factor);
        if (factor < 1.1) break;
      } else {
        point = std::move(stage.best);
        any = true;
        out.excess = std::min(out.excess, 0.5 * std::log(inputs) * mu);
        if (point.gap > 40.0 * mu) {  // simple after all: the other singular values weigh nothing
          theta = point.theta;
          descend_exactly(theta, out);
          if (met()) return;
        }
        before = last;
        mu_before = mu_last;
        last = point.theta;
        mu_last = mu;
        if (stage.evaluations <= 4) factor = std::min(factor * std::sqrt(factor), 1e3);
      }
      mu = (any ? mu_last : 0.25) / factor;
      start = last;
      if (mu_before > 0.0) start += ((mu - mu_last) / (mu_last - mu_before)) * (last - before);
    }
    if (!any) return;
    climb_from_active_vectors(point, out);
  }

  // Starts at combinations of the two leading pairs of singular vectors, until the best has been found three times.
  void climb_from_active_vectors(const typename Scalings::Point& point, SsvBounds& out) {
    double square = 0.0;
    for (Eigen::Index k = 0; k < point.weights.size(); ++k) square += point.weights(k) * point.weights(k);
    out.multiplicity = 1.0 / square;
    lower_found_ = 0;
    for (int k = 0; k < options_.max_climbs && !met() && lower_found_ < 3; ++k) {
      look(point, 60, kGoldenAngle * k, out);
    }
  }

  static constexpr int kExactEvaluations = 14;
  static constexpr int kStageEvaluations = 12;
  static constexpr double kGoldenAngle = 2.399963229728653;  // spreads any number of starts evenly over the circle

  const typename Scalings::Loop& x_;
  const typename Scalings::Radii& w_;
  Scalings scalings_;
  PhaseSearch phases_;
  const SsvOptions& options_;
  double best_ = std::numeric_limits<double>::infinity();
  double lower_ = 0.0;
  int lower_found_ = 0;
  typename PhaseSearch::Phases worst_;
};

template <int In, int Out>
SsvBounds solve(const Eigen::Ref<const Eigen::MatrixXcd>& x_in, const Eigen::Ref<const Eigen::MatrixXd>& radii_in,
                const SsvOptions& options, SsvScaling* scaling, WorstCase* worst) {
  using Scalings = ScalingProblem<In, Out>;
  const Eigen::Index n_in = x_in.rows(), n_out = x_in.cols();
  typename Scalings::Loop x = x_in;
  typename Scalings::Radii w = radii_in;
  keep_loops(x, w);
  SsvBounds out;
  // Scaled to order one, so that nothing under- or overflows.
  const double x_scale = std::max(x.real().cwiseAbs().maxCoeff(), x.imag().cwiseAbs().maxCoeff());
  const double w_scale = w.maxCoeff();
  if (worst != nullptr) worst->delta.resize(0, 0);
  if (x_scale == 0.0 || w_scale == 0.0) return out;
  x /= x_scale;
  w /= w_scale;
  typename Scalings::Variables theta(n_in + n_out - 2);
  const bool warm = scaling != nullptr && scaling->log_s.size() == n_out && scaling->log_t.size() == n_in;
  if (warm) {
    for (Eigen::Index i = 1; i < n_out; ++i) theta(i - 1) = scaling->log_s(i) - scaling->log_s(0);
    for (Eigen::Index j = 1; j < n_in; ++j) theta(n_out + j - 2) = scaling->log_t(j) - scaling->log_t(0);
  } else {
    perron_start<In, Out>(x, w, theta);
  }
  typename PhaseProblem<In, Out>::Phases phases;
  Solver<In, Out> solver(x, w, options);
  out = solver.solve(theta, phases);
  if (worst != nullptr && out.lower > 0.0) {
    const PhaseProblem<In, Out> problem(x, w);
    const auto attained = problem.evaluate(phases, out.lower, true);
    worst->delta = attained.perturbation * (w_scale / (attained.eigen.value * x_scale * w_scale));
  }
  out.upper *= x_scale * w_scale;
  out.lower *= x_scale * w_scale;
  if (scaling != nullptr) {
    scaling->log_s.setZero(n_out);
    scaling->log_t.setZero(n_in);
    for (Eigen::Index i = 1; i < n_out; ++i) scaling->log_s(i) = theta(i - 1);
    for (Eigen::Index j = 1; j < n_in; ++j) scaling->log_t(j) = theta(n_out + j - 2);
  }
  return out;
}

extern template SsvBounds solve<3, 3>(const Eigen::Ref<const Eigen::MatrixXcd>&, const Eigen::Ref<const Eigen::MatrixXd>&,
                                      const SsvOptions&, SsvScaling*, WorstCase*);
extern template SsvBounds solve<Eigen::Dynamic, Eigen::Dynamic>(const Eigen::Ref<const Eigen::MatrixXcd>&,
                                                                const Eigen::Ref<const Eigen::MatrixXd>&,
                                                                const SsvOptions&, SsvScaling*, WorstCase*);

}  // namespace fatmc::ssv
