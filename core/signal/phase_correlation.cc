#include "core/signal/phase_correlation.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/base/check.h"

namespace fatmc {
namespace {

double mean_direction(std::span<const double> x) {
  std::complex<double> sum = 0.0;
  for (const double phase : x) sum += std::polar(1.0, phase);
  return std::arg(sum);
}

/// P(R > r) for n uniform directions, r^2 n = z (Mardia & Jupp 2000, 6.3.5).
double rayleigh(double z, double n) {
  const double series = 1.0 + (2.0 * z - z * z) / (4.0 * n) -
                        (24.0 * z - 132.0 * z * z + 76.0 * z * z * z - 9.0 * z * z * z * z) / (288.0 * n * n);
  return std::clamp(std::exp(-z) * series, 0.0, 1.0);
}

}  // namespace

PhaseCorrelation phase_correlation(std::span<const double> x, std::span<const double> y) {
  FATMC_CHECK(x.size() == y.size() && x.size() >= 3, "pairs of phases");
  const double x0 = mean_direction(x), y0 = mean_direction(y);
  double xy = 0.0, xx = 0.0, yy = 0.0, xxyy = 0.0;
  std::complex<double> difference = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double a = std::sin(x[i] - x0), b = std::sin(y[i] - y0);
    xy += a * b;
    xx += a * a;
    yy += b * b;
    xxyy += a * a * b * b;
    difference += std::polar(1.0, x[i] - y[i]);
  }
  const auto n = static_cast<double>(x.size());
  PhaseCorrelation out;
  if (xx > 0.0 && yy > 0.0) out.rho = xy / std::sqrt(xx * yy);
  // sqrt(n) rho sqrt(l20 l02/l22) = sum ab / sqrt(sum a^2 b^2)
  if (xxyy > 0.0) out.p_rho = std::erfc(std::abs(xy) / std::sqrt(xxyy) / std::numbers::sqrt2);
  out.difference = std::abs(difference) / n;
  out.p_difference = rayleigh(n * out.difference * out.difference, n);
  return out;
}

}  // namespace fatmc
