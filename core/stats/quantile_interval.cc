#include "core/stats/quantile_interval.h"

#include <boost/math/distributions/binomial.hpp>
#include <limits>

#include "core/base/check.h"

namespace fatmc {

Interval quantile_interval(std::span<const double> sorted, double p, double level) {
  FATMC_CHECK(p > 0.0 && p < 1.0 && level > 0.0 && level < 1.0, "a quantile and a level");
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  Interval out{kNone, kNone};
  if (sorted.empty()) return out;
  const auto n = static_cast<int>(sorted.size());
  const boost::math::binomial_distribution<double> below(n, p);
  const double side = 0.5 * (1.0 - level);
  // The r-th smallest lies above the quantile with P(B < r) = P(B <= r - 1), below it with P(B >= r).
  int low = 0, high = n + 1;
  while (low < n && boost::math::cdf(below, low) <= side) ++low;
  while (high > 1 && boost::math::cdf(boost::math::complement(below, high - 2)) <= side) --high;
  if (low >= 1) out.low = sorted[static_cast<std::size_t>(low - 1)];
  if (high <= n) out.high = sorted[static_cast<std::size_t>(high - 1)];
  return out;
}

}  // namespace fatmc
