// Statistics of 20 runs' errors at one line: what Tables 3-2 and 3-3 and section 3.4.1 print.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "core/stats/intervals.h"

namespace fatmc::estimators {

/// Error of a run at the line in question.
using ErrorOfRun = std::function<double(std::size_t run)>;

RunMean mean_of(std::span<const std::size_t> runs, const ErrorOfRun& error);

/// Half width of the 90 % interval (Student's t) of the mean of `repetitions` runs that scatter as these do:
/// t(0.95; repetitions - 1) s / sqrt(repetitions). NaN for fewer than two runs.
double range_of_mean(std::span<const std::size_t> runs, const ErrorOfRun& error, std::size_t repetitions);

/// Whether the 90 % interval of the mean of these runs holds zero.
bool interval_holds_zero(std::span<const std::size_t> runs, const ErrorOfRun& error);

}  // namespace fatmc::estimators
