#include "core/discrepancy/effect_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/discrepancy/effect_size.h"

namespace fatmc {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// What the fit knows at one t.
struct Point {
  Vector t;
  Vector residual;  ///< all rows
  double cost = 0.0;
};

class Search {
 public:
  Search(const Comparison& comparison, std::vector<Effect> start, const std::vector<int>& rows,
         const FitOptions& options)
      : comparison_(comparison),
        effects_(std::move(start)),
        rows_(rows),
        options_(options),
        free_(free_parameters(effects_)) {}

  [[nodiscard]] const std::vector<FreeParameter>& free() const { return free_; }
  [[nodiscard]] std::vector<Effect> at(const Vector& t) const {
    std::vector<Effect> out = effects_;
    for (std::size_t i = 0; i < free_.size(); ++i)
      set_natural_value(out, free_[i], t[static_cast<Eigen::Index>(i)]);
    return out;
  }
  [[nodiscard]] Vector start() const {
    Vector t(static_cast<Eigen::Index>(free_.size()));
    for (std::size_t i = 0; i < free_.size(); ++i) {
      t[static_cast<Eigen::Index>(i)] =
          std::clamp(natural_value(effects_, free_[i]), free_[i].low, free_[i].high);
    }
    return t;
  }
  [[nodiscard]] double cost(const Vector& residual) const {
    if (rows_.empty()) return residual.squaredNorm();
    double sum = 0.0;
    for (const int r : rows_) sum += residual[r] * residual[r];
    return sum;
  }
  [[nodiscard]] Matrix fitted(const Matrix& all) const {
    if (rows_.empty()) return all;
    Matrix out(static_cast<Eigen::Index>(rows_.size()), all.cols());
    for (std::size_t i = 0; i < rows_.size(); ++i) out.row(static_cast<Eigen::Index>(i)) = all.row(rows_[i]);
    return out;
  }

  /// Residuals at several t in one go; false where a flight fails.
  [[nodiscard]] Matrix residuals(const std::vector<Vector>& points) const {
    std::vector<std::vector<Effect>> sets;
    for (const Vector& t : points) sets.push_back(at(t));
    return (-comparison_.changes(sets, options_.flights)).colwise() + comparison_.discrepancy();
  }

  bool evaluate(Point& point) const {
    const Matrix r = residuals({point.t});
    if (!r.allFinite()) return false;
    point.residual = r.col(0);
    point.cost = cost(point.residual);
    return true;
  }

  /// Residual and Jacobian; the differences step away from the nearer end of the range.
  bool linearise(Point& point, Matrix& jacobian) const {
    std::vector<Vector> points = {point.t};
    Vector step(point.t.size());
    for (std::size_t i = 0; i < free_.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      step[at] = point.t[at] + free_[i].step <= free_[i].high ? free_[i].step : -free_[i].step;
      points.push_back(point.t);
      points.back()[at] += step[at];
    }
    const Matrix r = residuals(points);
    if (!r.allFinite()) return false;
    point.residual = r.col(0);
    point.cost = cost(point.residual);
    jacobian = r.rightCols(step.size());
    for (Eigen::Index i = 0; i < step.size(); ++i) jacobian.col(i) = (r.col(0) - jacobian.col(i)) / step[i];
    return true;
  }

 private:
  const Comparison& comparison_;
  std::vector<Effect> effects_;
  const std::vector<int>& rows_;
  const FitOptions& options_;
  std::vector<FreeParameter> free_;
};

/// The step of (J^T J + damping diag) d = J^T r, inside the ranges.
Vector damped_step(const Search& search, const Point& at, const Matrix& normal, const Vector& gradient,
                   double damping) {
  Matrix damped = normal;
  damped.diagonal() *= 1.0 + damping;
  damped.diagonal().array() += 1e-12 * normal.diagonal().maxCoeff() + 1e-300;
  Vector t = at.t + damped.llt().solve(gradient);
  for (std::size_t i = 0; i < search.free().size(); ++i) {
    const auto p = static_cast<Eigen::Index>(i);
    t[p] = std::clamp(t[p], search.free()[i].low, search.free()[i].high);
  }
  return t;
}

}  // namespace

std::vector<FreeParameter> free_parameters(const std::vector<Effect>& effects) {
  std::vector<FreeParameter> out;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const EffectKind& kind = effects[e].kind();
    for (std::size_t p = 0; p < kind.parameters.size(); ++p) {
      const EffectParameter& parameter = kind.parameters[p];
      FreeParameter free{static_cast<int>(e), static_cast<int>(p), to_natural(parameter, parameter.low),
                         to_natural(parameter, parameter.high), 0.0};
      // A tenth of the least moderate size: far above rounding, well inside what is nearly linear. Limits and shapes have
      // no such size: 2 % of a limit, a thirtieth of the range that the shape is usually in.
      if (is_limit(parameter)) {
        free.step = 0.02;
      } else if (parameter.strength) {
        free.step = 0.1 * least_moderate(parameter);
      } else {
        free.step = std::abs(to_natural(parameter, parameter.moderate_high) -
                             to_natural(parameter, parameter.moderate_low)) /
                    30.0;
      }
      if (free.step == 0.0) free.step = 1e-3 * (free.high - free.low);
      out.push_back(free);
    }
  }
  return out;
}

double natural_value(const std::vector<Effect>& effects, const FreeParameter& free) {
  const Effect& effect = effects[static_cast<std::size_t>(free.effect)];
  const auto p = static_cast<std::size_t>(free.parameter);
  return to_natural(effect.kind().parameters[p], effect.values[p]);
}

void set_natural_value(std::vector<Effect>& effects, const FreeParameter& free, double t) {
  Effect& effect = effects[static_cast<std::size_t>(free.effect)];
  const auto p = static_cast<std::size_t>(free.parameter);
  const EffectParameter& kind = effect.kind().parameters[p];
  effect.values[p] =
      std::clamp(from_natural(kind, t), kind.low, kind.high);  // exp(log(x)) may pass an end by a rounding
}

EffectFit fit_effects(const Comparison& comparison, std::vector<Effect> start, const std::vector<int>& rows,
                      const FitOptions& options) {
  const Search search(comparison, std::move(start), rows, options);
  EffectFit out;
  Point at;
  at.t = search.start();
  Matrix jacobian;
  if (!search.linearise(at, jacobian)) return out;
  bool current = true;  // the Jacobian is that of `at`
  out.ending = EffectFit::Ending::iterations;
  double damping = 1e-3;
  for (out.steps = 0; out.steps < options.iterations; ++out.steps) {
    if (!current && !search.linearise(at, jacobian)) break;
    current = true;
    const Matrix j = search.fitted(jacobian);
    const Matrix normal = j.transpose() * j;
    const Vector gradient = j.transpose() * search.fitted(at.residual);
    Point next;
    double predicted = 0.0;
    bool better = false;
    for (int attempt = 0; attempt < 4 && !better; ++attempt, damping *= 8.0) {
      next.t = damped_step(search, at, normal, gradient, damping);
      const Vector step = next.t - at.t;
      predicted = 2.0 * gradient.dot(step) - step.dot(normal * step);
      if (predicted < options.enough + options.relative * at.cost) break;
      better = search.evaluate(next) && next.cost < at.cost;
    }
    if (!better) {
      out.ending = EffectFit::Ending::converged;
      break;
    }
    damping = std::max(1e-6, damping / 64.0);
    // A step that did what the linear model promised leaves a minimum to within what is enough.
    const bool as_promised =
        std::abs(at.cost - next.cost - predicted) < options.enough + options.relative * at.cost;
    at = std::move(next);
    current = false;
    if (as_promised) {
      out.ending = EffectFit::Ending::converged;
      ++out.steps;
      break;
    }
  }
  out.effects = search.at(at.t);
  out.cost = at.cost;
  out.residual = at.residual;
  out.jacobian = jacobian;
  const Matrix j = search.fitted(jacobian);
  Matrix normal = j.transpose() * j;
  normal.diagonal().array() += 1e-12 * normal.diagonal().maxCoeff() + 1e-300;
  out.covariance = normal.llt().solve(Matrix::Identity(normal.rows(), normal.cols()));
  return out;
}

}  // namespace fatmc
