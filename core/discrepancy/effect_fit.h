// Values of effects from records, by Gauss-Newton with real simulations.
//
//   minimise |W^-1 (z - m(t))|^2,  m(t) = mean over flights of the white change of the features (common random numbers)
//
// t are the effects' parameters on their natural scale (logarithms of factors, limits, frequencies); W is diagonal, what the
// noise of a feature with these effects is over that of the model (fitted_law.h), 1 where nothing is known yet. The
// dictionary's signatures are only a start: for large effects they are far from the change itself. Steps are
// Levenberg-Marquardt's; the Jacobian comes from differences of flights with the same noise.
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
  double enough = 0.1;     ///< stop when a step promises less than this gain in the cost, or errs by less ...
  double relative = 1e-4;  ///< ... plus this share of the cost
};

struct EffectFit {
  enum class Ending { converged, iterations, cannot_fly };
  Ending ending = Ending::cannot_fly;
  int steps = 0;
  std::vector<Effect> effects;
  double cost = 0.0;         ///< |W^-1 (z - m)|^2
  Eigen::VectorXd residual;  ///< z - m
  Eigen::MatrixXd jacobian;  ///< dm/dt, rows x free parameters, at the last step but one at the earliest
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

/// From a start inside the ranges. `deviation`: the diagonal of W, or empty.
EffectFit fit_effects(const Comparison& comparison, std::vector<Effect> start,
                      const Eigen::Ref<const Eigen::VectorXd>& deviation, const FitOptions& options);

/// The Gauss-Newton step in t of residual r and Jacobian J, both divided by W, clamped to the ranges around the values.
Eigen::VectorXd linear_step(const std::vector<Effect>& effects,
                            const Eigen::Ref<const Eigen::MatrixXd>& jacobian,
                            const Eigen::Ref<const Eigen::VectorXd>& residual);
/// The effects with their free parameters moved by d.
std::vector<Effect> moved(std::vector<Effect> effects, const Eigen::Ref<const Eigen::VectorXd>& d);

}  // namespace fatmc
