#include "core/discrepancy/effect_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/discrepancy/effect_size.h"

namespace fatmc {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double kShapeRange = 3.0;  // beyond the usual range of a shape, as a factor

/// What the fit knows at one t.
struct Point {
  Vector t;
  Vector residual;
  double cost = 0.0;
};

class Search {
 public:
  Search(const Comparison& comparison, std::vector<Effect> start, const Vector& deviation, int flights)
      : comparison_(comparison),
        effects_(std::move(start)),
        inverse_(deviation.size() == 0 ? Vector::Ones(comparison.size()) : Vector(deviation.cwiseInverse())),
        flights_(flights),
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
  /// W^-1 B.
  [[nodiscard]] Matrix weighted(const Matrix& b) const { return inverse_.asDiagonal() * b; }

  bool evaluate(Point& point) const { return linearise(point, nullptr); }

  /// Residual, and with `jacobian` its negative derivative; the differences step away from the nearer end of the range.
  bool linearise(Point& point, Matrix* jacobian) const {
    std::vector<std::vector<Effect>> sets = {at(point.t)};
    Vector steps(point.t.size());
    for (std::size_t i = 0; jacobian != nullptr && i < free_.size(); ++i) {
      const auto p = static_cast<Eigen::Index>(i);
      steps[p] = point.t[p] + free_[i].step <= free_[i].high ? free_[i].step : -free_[i].step;
      Vector t = point.t;
      t[p] += steps[p];
      sets.push_back(at(t));
    }
    const Matrix changes = comparison_.changes(sets, flights_);
    if (!changes.allFinite()) return false;
    point.residual = comparison_.discrepancy() - changes.col(0);
    point.cost = point.residual.cwiseProduct(inverse_).squaredNorm();
    if (jacobian == nullptr) return true;
    *jacobian =
        (changes.rightCols(steps.size()).colwise() - changes.col(0)) * steps.cwiseInverse().asDiagonal();
    return true;
  }

 private:
  const Comparison& comparison_;
  std::vector<Effect> effects_;
  Vector inverse_;
  int flights_;
  std::vector<FreeParameter> free_;
};

/// The step of (J^T J + damping diag) d = J^T r, inside the ranges.
Vector damped_step(const std::vector<FreeParameter>& free, const Vector& from, const Matrix& normal,
                   const Vector& gradient, double damping) {
  Matrix damped = normal;
  damped.diagonal() *= 1.0 + damping;
  damped.diagonal().array() += 1e-12 * normal.diagonal().maxCoeff() + 1e-300;
  Vector t = from + damped.llt().solve(gradient);
  for (std::size_t i = 0; i < free.size(); ++i) {
    const auto p = static_cast<Eigen::Index>(i);
    t[p] = std::clamp(t[p], free[i].low, free[i].high);
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
      // no such size: 2 % of a limit, a three-hundredth of the range that the shape is usually in (0.4 % of a mode's
      // frequency, whose peak may be 4 % wide).
      if (is_limit(parameter)) {
        free.step = 0.02;
      } else if (parameter.strength) {
        free.step = 0.1 * least_moderate(parameter);
      } else {
        free.step = std::abs(to_natural(parameter, parameter.moderate_high) -
                             to_natural(parameter, parameter.moderate_low)) /
                    300.0;
      }
      if (free.step == 0.0) free.step = 1e-3 * (free.high - free.low);
      // A mode of high damping far outside its usual place is a gain, and would be named for one.
      if (!parameter.strength && parameter.moderate_low > 0.0) {
        free.low = std::max(free.low, to_natural(parameter, parameter.moderate_low / kShapeRange));
        free.high = std::min(free.high, to_natural(parameter, parameter.moderate_high * kShapeRange));
      }
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

EffectFit fit_effects(const Comparison& comparison, std::vector<Effect> start,
                      const Eigen::Ref<const Vector>& deviation, const FitOptions& options) {
  const Search search(comparison, std::move(start), deviation, options.flights);
  EffectFit out;
  Point at;
  at.t = search.start();
  if (!search.linearise(at, &out.jacobian)) return out;
  bool current = true;  // the Jacobian is that of `at`
  out.ending = EffectFit::Ending::iterations;
  double damping = 1e-3;
  for (out.steps = 0; out.steps < options.iterations; ++out.steps) {
    if (!current && !search.linearise(at, &out.jacobian)) break;
    current = true;
    const double tolerance = options.enough + options.relative * at.cost;
    const Matrix j = search.weighted(out.jacobian);
    const Matrix normal = j.transpose() * j;
    const Vector gradient = j.transpose() * search.weighted(at.residual);
    Point next;
    double predicted = 0.0;
    bool better = false;
    for (int attempt = 0; attempt < 4 && !better; ++attempt, damping *= 8.0) {
      next.t = damped_step(search.free(), at.t, normal, gradient, damping);
      const Vector step = next.t - at.t;
      predicted = 2.0 * gradient.dot(step) - step.dot(normal * step);
      if (predicted < tolerance) break;
      better = search.evaluate(next) && next.cost < at.cost;
    }
    if (!better) {
      out.ending = EffectFit::Ending::converged;
      break;
    }
    damping = std::max(1e-6, damping / 64.0);
    // A step that did what the linear model promised leaves a minimum to within what is enough.
    const bool as_promised = std::abs(at.cost - next.cost - predicted) < tolerance;
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
  return out;
}

Vector linear_step(const std::vector<Effect>& effects, const Eigen::Ref<const Matrix>& jacobian,
                   const Eigen::Ref<const Vector>& residual) {
  const std::vector<FreeParameter> free = free_parameters(effects);
  Vector t(jacobian.cols());
  for (std::size_t i = 0; i < free.size(); ++i) {
    t[static_cast<Eigen::Index>(i)] = natural_value(effects, free[i]);
  }
  const Matrix normal = jacobian.transpose() * jacobian;
  return damped_step(free, t, normal, jacobian.transpose() * residual, 0.0) - t;
}

std::vector<Effect> moved(std::vector<Effect> effects, const Eigen::Ref<const Vector>& d) {
  const std::vector<FreeParameter> free = free_parameters(effects);
  for (std::size_t i = 0; i < free.size(); ++i) {
    const double t = natural_value(effects, free[i]) + d[static_cast<Eigen::Index>(i)];
    set_natural_value(effects, free[i], t);
  }
  return effects;
}

}  // namespace fatmc
