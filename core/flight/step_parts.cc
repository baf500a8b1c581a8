#include "core/flight/step_parts.h"

#include <algorithm>
#include <cmath>

namespace fatmc {
namespace {

/// The largest magnitude of the eigenvalues by Gelfand's formula, |A^n|^(1/n) with n = 2^10 and Frobenius' norm: never too
/// small, and too large by at most the factor (4 cond V)^(1/n) of the eigenvectors V, 2 % for cond V = 1e8.
double spectral_radius(LinearStateMatrix power) {
  constexpr int kSquarings = 10;
  double logarithm = 0.0, weight = 1.0;
  for (int i = 0; i <= kSquarings; ++i) {
    const double size = power.norm();
    if (!(size > 0.0)) return 0.0;
    logarithm += weight * std::log(size);
    power /= size;
    power = (power * power).eval();
    weight *= 0.5;
  }
  return std::exp(logarithm);
}

/// Magnitude of the faster pole of s^2 + 2 d w s + w^2.
double faster_pole(double frequency_hz, double damping) {
  const double w = 2.0 * kPi * frequency_hz, d = std::abs(damping);
  return d > 1.0 ? w * (d + std::sqrt(d * d - 1.0)) : w;
}

}  // namespace

int parts_of_step(const Aircraft& aircraft, const LinearModel& continuous, double step_s) {
  double fastest = spectral_radius(continuous.a);
  for (const FlexibleMode& mode : aircraft.additional.flexible) {
    if (mode.slope != 0.0) fastest = std::max(fastest, faster_pole(mode.frequency_hz, mode.damping));
  }
  const Slosh& slosh = aircraft.additional.slosh;
  if (slosh.mass_kg != 0.0) fastest = std::max(fastest, faster_pole(slosh.frequency_hz, slosh.damping));
  return std::max(1, static_cast<int>(std::ceil(fastest * step_s / kLargestModeStep - 1e-9)));
}

}  // namespace fatmc
