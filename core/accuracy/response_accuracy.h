// How well one frequency response stands for another: error response function, cost function, MUAD envelopes.
#pragma once

#include <complex>
#include <span>
#include <vector>

#include "core/base/error.h"

namespace fatmc {

/// Error response function at one frequency (T 3.6, 3.7).
struct ResponseError {
  double magnitude_db = 0.0;  ///< 20 log10 |G| - 20 log10 |G0|
  double phase_deg = 0.0;     ///< angle(G / G0) in (-180, 180]: the wrapped difference, as no record tells turns apart
};

/// Fails where either response is zero or not finite: it has no magnitude in dB there.
Result<ResponseError> response_error(std::complex<double> g, std::complex<double> g0);

/// Weights of the cost function (T 3.10, 3.11): 1 dB counts as 7.57 deg.
inline constexpr double kMagnitudeWeight = 1.0, kPhaseWeight = 0.01745;

/// 20/n sum (W_mag e_mag^2 + W_angle e_angle^2), dB and degrees (T 3.8, 3.9). Below 100 acceptable, below 50 hardly to be
/// told from flight data (Tischler & Remple 2006). At least one error.
double response_cost(std::span<const ResponseError> errors);

/// Limits of additional dynamics that pilots do not notice in pitch (T 3.3.3; MIL-HDBK-1797 after Wood & Hodgkinson).
/// UNVERIFIED: neither source prints the constants; they are quoted from the standard from memory.
struct UnnoticedDynamics {
  double upper_db = 0.0, lower_db = 0.0;
  double upper_deg = 0.0, lower_deg = 0.0;
};

/// At `frequency_hz` > 0: magnitude and phase of rational functions of s = j 2 pi f (rad/s) with delays; phases by
/// the argument in (-180, 180] deg of the rational part plus the delay's. About +2.7/-1.7 dB, +30/-14 deg at 1 rad/s.
UnnoticedDynamics unnoticed_dynamics(double frequency_hz);

/// Inside all four limits.
bool unnoticed(const ResponseError& error, double frequency_hz);

}  // namespace fatmc
