// How little turbulence disturbs the loop's input, and the input SNR that follows (T 5.2.1, 5.9).
//
// Rotating air t = (p_g, q_g, r_g) moves the aircraft by H = G_2 G_4, from t to the measured rate of the same
// axis, controls fixed. It reaches the input through the loop as the reference does, so that the loop cancels
// from the ratio:
//
//   SNR(U) = |G_ur r| / |G_ut t| = |r| / |H t| = S |r| / |t|,   S = 1/|H| (5.8, 5.9)
//
// S is small where the airframe resonates. The other axes, the translational gusts and the sensors are left
// out, as in T's Figure 5-2: the SNR below is that of this one contribution, an upper bound for what a flight
// shows.
#pragma once

#include <array>

#include "core/flight/linear_model.h"

namespace fatmc {

/// S of roll, pitch and yaw at one frequency: ratios, not dB.
std::array<double, 3> turbulence_insensitivity(const LinearModel& model, double frequency_hz);

/// (5.9) for a line of `amplitude` (rad/s, peak) over `duration_s` in Dryden turbulence: S |R|/|T| with |R| =
/// amplitude sqrt(N)/2 and |T|^2 = f_s S_t(f), the DFT's convention; the sampling rate cancels. Infinite in
/// calm air.
double turbulence_limited_snr(const LinearModel& model, int axis, double frequency_hz, double amplitude,
                              double duration_s, double sigma_m_s, double airspeed_m_s, double span_m);

}  // namespace fatmc
