#include "core/flight/turbulence_insensitivity.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/check.h"
#include "core/flight/dryden.h"

namespace fatmc {

std::array<double, 3> turbulence_insensitivity(const LinearModel& model, double frequency_hz) {
  const auto h = model.gust_response(frequency_hz);
  return {1.0 / std::abs(h(0, 3)), 1.0 / std::abs(h(1, 4)), 1.0 / std::abs(h(2, 5))};
}

double turbulence_limited_snr(const LinearModel& model, int axis, double frequency_hz, double amplitude,
                              double duration_s, double sigma_m_s, double airspeed_m_s, double span_m) {
  FATMC_CHECK(axis >= 0 && axis < 3 && duration_s > 0.0, "an axis and a record");
  if (!(sigma_m_s > 0.0)) return std::numeric_limits<double>::infinity();
  // Two-sided per Hz: pi Phi(2 pi f). |R|/|T| = amplitude sqrt(N)/2 / sqrt(f_s S) = amplitude/2
  // sqrt(duration/S).
  const double density = std::numbers::pi * dryden_psd(3 + axis, 2.0 * std::numbers::pi * frequency_hz,
                                                       sigma_m_s, airspeed_m_s, span_m);
  const double s = turbulence_insensitivity(model, frequency_hz)[static_cast<std::size_t>(axis)];
  return s * 0.5 * amplitude * std::sqrt(duration_s / density);
}

}  // namespace fatmc
