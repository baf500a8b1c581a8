// Internal to core/flight: an aircraft with its controller and signal path, ready to fly.
#pragma once

#include <cmath>

#include "core/flight/additional_dynamics.h"
#include "core/flight/imu.h"
#include "core/flight/signal_path.h"

namespace fatmc {

/// Constants of one stage of a flight; most flights have one.
struct PreparedStage {
  /// A delay of the commands as ticks and the Runge-Kutta steps before and after they arrive within a tick.
  struct Delay {
    Delay(double delay_s, double tick_s, double step_s) : ticks(static_cast<int>(delay_s / tick_s + 1e-9)) {
      const double fraction = delay_s - ticks * tick_s;
      const auto steps = [&](double span) { return static_cast<int>(std::ceil(span / step_s - 1e-9)); };
      if (fraction > 1e-9 * tick_s) {
        steps_before = std::max(1, steps(fraction));
        step_before_s = fraction / steps_before;
        steps_after = std::max(1, steps(tick_s - fraction));
        step_after_s = (tick_s - fraction) / steps_after;
      } else {
        steps_after = static_cast<int>(std::lround(tick_s / step_s));
        step_after_s = tick_s / steps_after;
      }
    }
    int ticks;
    int steps_before = 0, steps_after = 0;
    double step_before_s = 0.0, step_after_s = 0.0;
  };

  double from_s;
  FlightConstants constants;
  AdditionalDynamics additional;
  Gyro gyro;
  Eigen::Vector3d gain;
  SignalPath path;
  Delay delay;
};

}  // namespace fatmc
