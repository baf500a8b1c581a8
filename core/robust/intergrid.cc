#include "core/robust/intergrid.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/check.h"

namespace fatmc {
namespace {

// x at which |1 + j x| = 1 + error.
double detuning(double error) { return std::sqrt(error * (2.0 + error)); }

}  // namespace

double three_db_damping(double spacing_hz, double frequency_hz) {
  FATMC_CHECK(spacing_hz > 0.0 && frequency_hz > 0.0, "spacing and frequency of a resonance");
  return spacing_hz / (2.0 * frequency_hz);
}

double printed_three_db_damping(double spacing_hz, double frequency_hz) {
  return three_db_damping(spacing_hz, frequency_hz) / (2.0 * std::numbers::pi);
}

double intergrid_error(double relative_spacing, double damping) {
  FATMC_CHECK(relative_spacing >= 0.0 && damping > 0.0, "a damped resonance");
  const double x = relative_spacing / (2.0 * damping);
  // hypot(1, x) − 1 without cancellation at small x.
  return x * x / (std::hypot(1.0, x) + 1.0);
}

double largest_relative_spacing(double damping, double error) {
  FATMC_CHECK(damping >= 0.0 && error >= 0.0, "damping and error");
  return 2.0 * damping * detuning(error);
}

double covered_damping(double relative_spacing, double error) {
  FATMC_CHECK(relative_spacing >= 0.0 && error >= 0.0, "spacing and error");
  if (relative_spacing == 0.0) return 0.0;
  return error > 0.0 ? relative_spacing / (2.0 * detuning(error)) : std::numeric_limits<double>::infinity();
}

}  // namespace fatmc
