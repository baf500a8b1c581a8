// Steady level flight.
#pragma once

#include "core/flight/dynamics.h"

namespace fatmc {

/// Level straight flight at the aircraft's trim speed: du/dt = dw/dt = dq/dt = dn/dt = 0 in angle of attack
/// (equal to pitch), eta, throttle and propeller speed, by Newton's method with exact derivatives.
struct Trim {
  enum class Outcome { converged, not_converged, outside_model };
  Outcome outcome = Outcome::not_converged;
  int iterations = 0;
  double residual = 0.0;  ///< largest |dx/dt| over the whole state, SI units
  double alpha_rad = 0.0;
  double eta_rad = 0.0;
  double throttle = 0.0;
  double propeller_hz = 0.0;
  double thrust_n = 0.0;
  State<double> state{};
  Demand<double> demand{};
  [[nodiscard]] bool usable() const { return outcome == Outcome::converged; }
};

/// `outside_model`: a solution exists but needs a throttle outside [0, 1], a deflection beyond its stop, or
/// an angle of attack beyond the aircraft's validity.
Trim trim_level(const Aircraft& aircraft);

}  // namespace fatmc
