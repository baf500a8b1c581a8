// How short Runge-Kutta steps have to be.
#pragma once

#include "core/flight/linear_model.h"

namespace fatmc {

/// Into how many equal parts a Runge-Kutta step of `step_s` is split so that the fastest mode of the linearised aircraft, or of
/// its flexible parts, moves by |lambda h| <= kLargestModeStep in each.
///
/// The classical method is stable on the negative real axis down to lambda h = -2.785, on the imaginary one to 2.828 (Hairer &
/// Wanner, Solving Ordinary Differential Equations II, IV.2). A servo of 40 rad/s whose damping ratio becomes 0.9 * 2.1 has its
/// faster pole at -139.8 1/s: it diverges at 0.02 s, where the bound is -139.3. Long before, the mode is wrong (at -1.5 the
/// factor of a step is 0.273 instead of 0.223, at -2.7 it is 0.883 instead of 0.067). The published aircraft, whose fastest pole
/// is the motor controller's -56.4 1/s, is flown in whole steps of 0.02 s.
inline constexpr double kLargestModeStep = 1.5;
int parts_of_step(const Aircraft& aircraft, const LinearModel& continuous, double step_s);

}  // namespace fatmc
