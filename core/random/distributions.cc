#include "core/random/distributions.h"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <numbers>

#include "core/base/check.h"

namespace fatmc {
namespace {

double phi(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

double phi_inverse(double p) { return -std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * p); }

constexpr double kPivot = 1e-10;

}  // namespace

double draw_uniform(RandomStream& stream, double low, double high) {
  FATMC_CHECK(low <= high, "an interval");
  return low + (high - low) * stream.uniform();
}

double draw_normal(RandomStream& stream, double mean, double sd) {
  FATMC_CHECK(sd >= 0.0, "a standard deviation");
  return mean + sd * stream.normal();
}

double normal_probability(double mean, double sd, double low, double high) {
  double a = (low - mean) / sd, b = (high - mean) / sd;
  if (a > 0.0) {  // the mirror image, whose distribution function is small and keeps its digits
    std::swap(a, b);
    a = -a;
    b = -b;
  }
  return phi(b) - phi(a);
}

double draw_truncated_normal(RandomStream& stream, double mean, double sd, double low, double high) {
  FATMC_CHECK(sd > 0.0 && low < high, "a law and an interval");
  double a = (low - mean) / sd, b = (high - mean) / sd;
  const bool mirrored = a > 0.0;
  if (mirrored) {
    std::swap(a, b);
    a = -a;
    b = -b;
  }
  const double below = phi(a), width = phi(b) - below;
  FATMC_CHECK(width > 0.0, "an interval with probability");
  const double u = stream.uniform() + 0x1.0p-54;  // never 0, whose inverse is infinite
  const double z = std::clamp(phi_inverse(std::min(below + u * width, 1.0 - 0x1.0p-53)), a, b);
  return std::clamp(mean + sd * (mirrored ? -z : z), low, high);
}

double draw_log_normal(RandomStream& stream, double median, double log_sd) {
  FATMC_CHECK(median > 0.0 && log_sd >= 0.0, "a median and a deviation");
  return median * std::exp(log_sd * stream.normal());
}

std::vector<std::vector<double>> correlation_factor(const std::vector<std::vector<double>>& c) {
  const std::size_t n = c.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (c[i].size() != n || c[i][i] != 1.0) return {};
    for (std::size_t j = 0; j < i; ++j) {
      if (!(std::abs(c[i][j] - c[j][i]) <= 1e-12)) return {};
    }
  }
  std::vector<std::vector<double>> factor(n, std::vector<double>(n, 0.0));
  for (std::size_t j = 0; j < n; ++j) {
    double pivot = c[j][j];
    for (std::size_t k = 0; k < j; ++k) pivot -= factor[j][k] * factor[j][k];
    if (!(pivot >= -kPivot)) return {};
    const bool degenerate = pivot < kPivot;
    factor[j][j] = degenerate ? 0.0 : std::sqrt(pivot);
    for (std::size_t i = j + 1; i < n; ++i) {
      double rest = c[i][j];
      for (std::size_t k = 0; k < j; ++k) rest -= factor[i][k] * factor[j][k];
      if (degenerate && std::abs(rest) > 1e-5) return {};  // |rest| <= sqrt(pivot) where C is semidefinite
      factor[i][j] = degenerate ? 0.0 : rest / factor[j][j];
    }
  }
  return factor;
}

std::vector<double> draw_correlated(RandomStream& stream, const std::vector<double>& mean,
                                    const std::vector<double>& sd,
                                    const std::vector<std::vector<double>>& factor) {
  const std::size_t n = mean.size();
  FATMC_CHECK(sd.size() == n && factor.size() == n, "one size");
  std::vector<double> z(n), x(n);
  for (double& value : z) value = stream.normal();
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0.0;
    for (std::size_t j = 0; j <= i; ++j) sum += factor[i][j] * z[j];
    x[i] = mean[i] + sd[i] * sum;
  }
  return x;
}

}  // namespace fatmc
