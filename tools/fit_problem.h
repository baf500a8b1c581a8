// The fit of the FAT's unpublished derivatives: parameters with priors, targets, and a Gauss-Newton solver.
#pragma once

#include <Eigen/Dense>
#include <functional>
#include <string>
#include <vector>

#include "core/flight/aircraft.h"

namespace fatmc::fit {

/// One number of the aircraft that the fit may change, pulled towards what such an aircraft plausibly has.
struct Parameter {
  std::string name;
  std::function<double&(Aircraft&)> of;
  double prior;
  double spread;  ///< standard deviation of the prior
};

/// A published figure: residual = (model - value) / tolerance.
struct Target {
  std::string name;
  double value;
  double tolerance;
};

struct Problem {
  Aircraft start;
  std::vector<Parameter> parameters;
  std::vector<Target> targets;
  /// Model values in the order of the targets.
  std::function<Eigen::VectorXd(const Aircraft&)> model;
};

struct Fit {
  Aircraft aircraft;
  bool converged = false;
  int iterations = 0;
  double step = 0.0;         ///< last step in units of the priors' spreads
  Eigen::VectorXd reached;   ///< model values
};

/// Minimises sum ((model - value)/tolerance)^2 + sum ((parameter - prior)/spread)^2 by Levenberg-Marquardt with
/// central differences. The tolerances of targets are so small that they hold like constraints; the priors choose
/// among what is left.
Fit solve(const Problem& problem);

}  // namespace fatmc::fit
