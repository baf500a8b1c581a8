// Values of effects from records, by Gauss-Newton with real simulations.
//
//   minimise |z - m(t)|^2,  m(t) = mean over flights of the white change of the features (common random numbers)
//
// t are the effects' parameters on their natural scale (logarithms of factors, limits, frequencies). The dictionary's
// signatures are only a start: for large effects they are far from the change itself. Steps are Levenberg-Marquardt's; the
// Jacobian comes from differences of flights with the same noise. Intervals: t +- 1.96 sqrt((J^T J)^-1), the Fisher matrix
// of white noise.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/discrepancy/comparison.h"

namespace fatmc {

struct FitOptions {
  int flights =
      2;  ///< behind every m(t): its own noise is that of a record over their number, times the effect's share
  int iterations = 5;
  double enough = 0.1;  ///< stop when a step promises less than this gain in |z - m|^2, or errs by less ...
  double relative = 1e-4;  ///< ... plus this share of |z - m|^2
};

struct EffectFit {
  enum class Ending { converged, iterations, cannot_fly };
  Ending ending = Ending::cannot_fly;
  int steps = 0;
  std::vector<Effect> effects;
  double cost = 0.0;         ///< |z - m|^2 over the rows that were fitted
  Eigen::VectorXd residual;  ///< z - m, all rows
  Eigen::MatrixXd jacobian;  ///< dm/dt, all rows x free parameters, at the last step but one at the earliest
  Eigen::MatrixXd covariance;  ///< of t
  [[nodiscard]] bool usable() const { return ending != Ending::cannot_fly; }
};

/// A free parameter: which, and its range on the natural scale (effect_size.h).
struct FreeParameter {
  int effect = 0, parameter = 0;
  double low = 0.0, high = 0.0;  ///< of t
  double step = 0.0;             ///< of the differences
};
std::vector<FreeParameter> free_parameters(const std::vector<Effect>& effects);
double natural_value(const std::vector<Effect>& effects, const FreeParameter& free);
void set_natural_value(std::vector<Effect>& effects, const FreeParameter& free, double t);

/// From a start inside the ranges. `rows`: the part of the stack that is fitted; empty: all.
EffectFit fit_effects(const Comparison& comparison, std::vector<Effect> start, const std::vector<int>& rows,
                      const FitOptions& options);

}  // namespace fatmc
