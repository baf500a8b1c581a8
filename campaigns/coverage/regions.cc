#include "campaigns/coverage/regions.h"

#include <algorithm>

#include "core/base/check.h"
#include "core/stats/confidence.h"

namespace fatmc::coverage {

std::string_view region_name(Region region) {
  switch (region) {
    case Region::plain:
      return "without bias (5.13)";
    case Region::extended:
      return "extended, max(0, |e| - b)";
    case Region::extended_as_printed:
      return "extended, |e| - b as printed (5.14)";
    case Region::extended_printed_constant:
      return "extended, max(0, |e| - b), printed constant";
    case Region::printed_constant_as_printed:
      return "extended, |e| - b as printed, printed constant";
    case Region::sample:
      return "error against the sample mean";
  }
  FATMC_CHECK(false, "not a region");
}

bool needs_printed_constant(Region region) {
  return region == Region::extended_printed_constant || region == Region::printed_constant_as_printed;
}

double normalised_square(const TrialErrors& trial, Region region, std::size_t index) {
  const double variance = trial.variance[index];
  const auto extended = [&](double bias) { return std::max(0.0, std::abs(trial.error[index]) - bias); };
  const auto as_printed = [&](double bias) { return std::abs(trial.error[index]) - bias; };
  double distance = 0.0;
  switch (region) {
    case Region::plain:
      return std::norm(trial.error[index]) / variance;
    case Region::sample:
      return std::norm(trial.sample_error[index]) / variance;
    case Region::extended:
      distance = extended(trial.bias[index]);
      break;
    case Region::extended_as_printed:
      distance = as_printed(trial.bias[index]);
      break;
    case Region::extended_printed_constant:
      distance = extended(trial.bias_printed[index]);
      break;
    case Region::printed_constant_as_printed:
      distance = as_printed(trial.bias_printed[index]);
      break;
  }
  return distance * distance / variance;
}

TrialCoverage trial_coverage(const TrialErrors& trial, Region region, double level,
                             std::size_t elements_per_line, int degrees_of_freedom) {
  const double limit = f_quantile_2_2q(level, degrees_of_freedom);
  const double elements = static_cast<double>(elements_per_line);
  const double bonferroni_limit =
      f_quantile_2_2q(bonferroni_level(level, static_cast<int>(elements_per_line)), degrees_of_freedom);
  const std::size_t lines = trial.error.size() / elements_per_line;
  std::size_t inside = 0, lines_inside = 0, lines_inside_bonferroni = 0;
  for (std::size_t line = 0; line < lines; ++line) {
    double largest = 0.0;
    for (std::size_t element = 0; element < elements_per_line; ++element) {
      const double square = normalised_square(trial, region, line * elements_per_line + element);
      inside += square <= limit ? 1 : 0;
      largest = std::max(largest, square);
    }
    lines_inside += largest <= limit ? 1 : 0;
    lines_inside_bonferroni += largest <= bonferroni_limit ? 1 : 0;
  }
  const double n = static_cast<double>(lines);
  return {static_cast<double>(inside) / (n * elements), static_cast<double>(lines_inside) / n,
          static_cast<double>(lines_inside_bonferroni) / n};
}

}  // namespace fatmc::coverage
