#include "core/stats/intervals.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

#include "core/base/check.h"

namespace fatmc {
namespace {

Interval around(double mean, const RunMean& runs, double factor, double level) {
  FATMC_CHECK(level > 0.0 && level < 1.0, "a level between 0 and 1");
  const double infinity = std::numeric_limits<double>::infinity();
  if (runs.n < 2) return {-infinity, infinity};
  const double half = t_quantile(0.5 + 0.5 * level, static_cast<double>(runs.n - 1)) * runs.deviation * factor;
  return {mean - half, mean + half};
}

}  // namespace

Interval proportion_interval(std::uint64_t hits, std::uint64_t n, double level) {
  FATMC_CHECK(hits <= n && level > 0.0 && level < 1.0, "hits of n trials, a level between 0 and 1");
  if (n == 0) return {0.0, 1.0};
  const double z = boost::math::quantile(boost::math::normal(), 0.5 + 0.5 * level);
  const double count = static_cast<double>(n);
  const double p = static_cast<double>(hits) / count;
  const double denominator = 1.0 + z * z / count;
  const double centre = (p + 0.5 * z * z / count) / denominator;
  const double half = z * std::sqrt(p * (1.0 - p) / count + 0.25 * z * z / (count * count)) / denominator;
  return {hits == 0 ? 0.0 : std::max(0.0, centre - half), hits == n ? 1.0 : std::min(1.0, centre + half)};
}

RunMean mean_over_runs(std::span<const double> values) {
  RunMean runs;
  runs.n = values.size();
  if (values.empty()) return runs;
  const double n = static_cast<double>(values.size());
  for (const double v : values) runs.mean += v;
  runs.mean /= n;
  if (values.size() < 2) return runs;
  double square = 0.0;
  for (const double v : values) square += (v - runs.mean) * (v - runs.mean);
  runs.deviation = std::sqrt(square / (n - 1.0));
  runs.standard_error = runs.deviation / std::sqrt(n);
  return runs;
}

double t_quantile(double p, double dof) {
  FATMC_CHECK(p > 0.0 && p < 1.0 && dof > 0.0, "a probability and degrees of freedom");
  return boost::math::quantile(boost::math::students_t(dof), p);
}

Interval mean_interval(const RunMean& runs, double level) {
  return around(runs.mean, runs, 1.0 / std::sqrt(static_cast<double>(std::max<std::uint64_t>(runs.n, 1))), level);
}

Interval prediction_interval(const RunMean& runs, std::uint64_t m, double level) {
  FATMC_CHECK(m >= 1, "at least one further run");
  const double n = static_cast<double>(std::max<std::uint64_t>(runs.n, 1));
  return around(runs.mean, runs, std::sqrt(1.0 / n + 1.0 / static_cast<double>(m)), level);
}

}  // namespace fatmc
