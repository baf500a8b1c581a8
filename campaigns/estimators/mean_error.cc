#include "campaigns/estimators/mean_error.h"

#include <cmath>
#include <limits>
#include <vector>

namespace fatmc::estimators {

RunMean mean_of(std::span<const std::size_t> runs, const ErrorOfRun& error) {
  std::vector<double> values;
  values.reserve(runs.size());
  for (const std::size_t run : runs) values.push_back(error(run));
  return mean_over_runs(values);
}

double range_of_mean(std::span<const std::size_t> runs, const ErrorOfRun& error, std::size_t repetitions) {
  const RunMean mean = mean_of(runs, error);
  if (mean.n < 2 || repetitions < 2) return std::numeric_limits<double>::quiet_NaN();
  const auto n = static_cast<double>(repetitions);
  return t_quantile(0.95, n - 1.0) * mean.deviation / std::sqrt(n);
}

bool interval_holds_zero(std::span<const std::size_t> runs, const ErrorOfRun& error) {
  const Interval interval = mean_interval(mean_of(runs, error), 0.9);
  return interval.low <= 0.0 && interval.high >= 0.0;
}

}  // namespace fatmc::estimators
