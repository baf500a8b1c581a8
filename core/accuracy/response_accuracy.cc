#include "core/accuracy/response_accuracy.h"

#include <array>
#include <cmath>
#include <numbers>

#include "core/base/check.h"

namespace fatmc {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

double decibel(double ratio) { return 20.0 * std::log10(ratio); }

/// (n2 s^2 + n1 s + n0)/(s^2 + d1 s + d0) e^(delay s)
struct Envelope {
  std::array<double, 3> numerator;
  std::array<double, 2> denominator;
  double delay_s = 0.0;

  [[nodiscard]] std::complex<double> rational(double w) const {
    const std::complex<double> s(0.0, w);
    return (numerator[0] * s * s + numerator[1] * s + numerator[2]) / (s * s + denominator[0] * s + denominator[1]);
  }
  [[nodiscard]] double magnitude_db(double w) const { return decibel(std::abs(rational(w))); }
  [[nodiscard]] double phase_deg(double w) const { return (std::arg(rational(w)) + delay_s * w) * kDegrees; }
};

// Unverified, see the header.
constexpr Envelope kGainUpper{{3.16, 31.61, 22.79}, {27.14, 1.84}};
constexpr Envelope kGainLower{{0.0955, 9.92, 2.15}, {11.60, 4.96}};
constexpr Envelope kPhaseUpper{{68.89, 1100.12, -275.22}, {39.94, 9.99}, 0.0059};
constexpr Envelope kPhaseLower{{475.32, 184100.0, 29460.0}, {11.66, 0.0389}, -0.0072};

}  // namespace

Result<ResponseError> response_error(std::complex<double> g, std::complex<double> g0) {
  const double magnitude = std::abs(g), reference = std::abs(g0);
  if (!(magnitude > 0.0) || !(reference > 0.0) || !std::isfinite(magnitude) || !std::isfinite(reference)) {
    return fail("a response of zero has no magnitude in dB: leave the line out");
  }
  return ResponseError{decibel(magnitude) - decibel(reference), std::arg((g / magnitude) * std::conj(g0 / reference)) * kDegrees};
}

double response_cost(std::span<const ResponseError> errors) {
  FATMC_CHECK(!errors.empty(), "at least one frequency");
  double sum = 0.0;
  for (const ResponseError& e : errors) {
    sum += kMagnitudeWeight * e.magnitude_db * e.magnitude_db + kPhaseWeight * e.phase_deg * e.phase_deg;
  }
  return 20.0 * sum / static_cast<double>(errors.size());
}

UnnoticedDynamics unnoticed_dynamics(double frequency_hz) {
  FATMC_CHECK(frequency_hz > 0.0, "a frequency");
  const double w = 2.0 * std::numbers::pi * frequency_hz;
  return {kGainUpper.magnitude_db(w), kGainLower.magnitude_db(w), kPhaseUpper.phase_deg(w), kPhaseLower.phase_deg(w)};
}

bool unnoticed(const ResponseError& error, double frequency_hz) {
  const UnnoticedDynamics limit = unnoticed_dynamics(frequency_hz);
  return error.magnitude_db <= limit.upper_db && error.magnitude_db >= limit.lower_db &&
         error.phase_deg <= limit.upper_deg && error.phase_deg >= limit.lower_deg;
}

}  // namespace fatmc
