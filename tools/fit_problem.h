// The fit of the FAT's unpublished derivatives: parameters with priors, targets, and a solver.
#pragma once

#include <Eigen/Dense>
#include <functional>
#include <string>
#include <vector>

#include "core/flight/aircraft.h"

namespace fatmc::fit {

/// A number that the fit may change, pulled towards what is plausible.
struct Prior {
  std::string name;
  double value;
  double spread;  ///< standard deviation
};

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
  bool exact = false;  ///< a constraint; the tolerance then is its scale alone
};

struct ValueProblem {
  std::vector<Prior> priors;
  std::vector<Target> targets;
  /// Model values in the order of the targets, from values in the order of the priors.
  std::function<Eigen::VectorXd(const Eigen::VectorXd&)> model;
};

struct ValueFit {
  Eigen::VectorXd values;
  bool converged = false;
  int iterations = 0;
  double step = 0.0;        ///< last step in units of the priors' spreads
  double violation = 0.0;   ///< largest residual of the exact targets
  Eigen::VectorXd reached;  ///< model values
};

/// Minimises sum ((model - value)/tolerance)^2 over the other targets + sum ((parameter - prior)/spread)^2
/// subject to model = value for the exact targets: Levenberg-Marquardt with the constraints as penalties
/// comes near, Newton's method on the Lagrangian ends it. The priors choose among what the targets leave
/// free.
ValueFit solve(const ValueProblem& problem);

/// The same for an aircraft.
struct Problem {
  Aircraft start;
  std::vector<Parameter> parameters;
  std::vector<Target> targets;
  /// Model values in the order of the targets.
  std::function<Eigen::VectorXd(const Aircraft&)> model;
};

struct Fit : ValueFit {
  Aircraft aircraft;
};

Fit solve(const Problem& problem);

}  // namespace fatmc::fit
