#include "core/stats/extreme_prediction.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/check.h"

namespace fatmc {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kNodes = 200;  // of each quantile: the factor then errs by less than 2e-3

// E [1 - Phi(z + k w)]^m by the midpoint rule over the probabilities of z and w.
class NormalExceedance {
 public:
  NormalExceedance(std::uint64_t n, std::uint64_t m) : m_(static_cast<double>(m)) {
    const boost::math::normal normal;
    const boost::math::chi_squared chi_squared(static_cast<double>(n - 1));
    for (int i = 0; i < kNodes; ++i) {
      const double p = (i + 0.5) / kNodes;
      z_.push_back(boost::math::quantile(normal, p) / std::sqrt(static_cast<double>(n)));
      w_.push_back(std::sqrt(boost::math::quantile(chi_squared, p) / static_cast<double>(n - 1)));
    }
  }
  [[nodiscard]] double operator()(double k) const {
    double sum = 0.0;
    for (const double w : w_) {
      for (const double z : z_) sum += std::pow(0.5 * std::erfc((z + k * w) / std::sqrt(2.0)), m_);
    }
    return sum / (kNodes * kNodes);
  }

 private:
  double m_;
  std::vector<double> z_, w_;
};

}  // namespace

Interval smallest_prediction(std::span<const double> values, std::uint64_t m, double level) {
  Interval out{-kInfinity, kInfinity};
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const double tail = (1.0 - level) / 2.0;
  const auto n = static_cast<double>(sorted.size());
  double all_above = 1.0;  // P(min > x_(j))
  for (std::size_t j = 0; j < sorted.size(); ++j) {
    const auto i = static_cast<double>(j);
    all_above *= (n - i) / (n + static_cast<double>(m) - i);
    if (1.0 - all_above <= tail) out.low = sorted[j];
    if (all_above <= tail) {
      out.high = sorted[j];
      break;
    }
  }
  return out;
}

double normal_smallest_factor(std::uint64_t n, std::uint64_t m, double p) {
  FATMC_CHECK(n >= 2 && m >= 1 && p > 0.0 && p < 1.0, "two values and a probability");
  const NormalExceedance above(n, m);
  double low = -1.0, high = 1.0;
  while (above(low) < p) low *= 2.0;
  while (above(high) > p) high *= 2.0;
  while (high - low > 1e-4) {
    const double middle = 0.5 * (low + high);
    (above(middle) > p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Interval normal_smallest_prediction(std::span<const double> values, std::uint64_t m, double level) {
  const RunMean runs = mean_over_runs(values);
  if (runs.n < 2) return {-kInfinity, kInfinity};
  const double tail = (1.0 - level) / 2.0;
  return {runs.mean + runs.deviation * normal_smallest_factor(runs.n, m, 1.0 - tail),
          runs.mean + runs.deviation * normal_smallest_factor(runs.n, m, tail)};
}

}  // namespace fatmc
