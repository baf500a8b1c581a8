// The rate loop of a flight, closed and linearised about level flight.
#pragma once

#include "core/flight/flight.h"

namespace fatmc {

/// From references (p, q, r) to measured rates, u = K (r - y), K = diag(gain) in s/rad, sampled at the flight's rate:
///
///   x[k+1] = (A - B K C_f) x[k] + B K r[k],   y = C x
///
/// C_f = C, less (g/V) cos(theta_0) phi in the yaw row where the turn coordinator adds r_ct = (g/V) sin(phi) cos(theta) to
/// the yaw reference (T 3.2, with g for the printed m): its derivative in straight level flight. y is read before the new u
/// acts, as in flight.h. The result's gust input is that of the plant.
LinearModel closed_rate_loop(const Flight& flight, const Eigen::Vector3d& gain, bool turn_coordinator);

}  // namespace fatmc
