// An interval for a quantile without any assumption on the law.
#pragma once

#include <span>

#include "core/stats/intervals.h"

namespace fatmc {

/// Interval for the p-quantile from sorted independent values, 0 < p < 1: order statistics whose ranks the number of values
/// below the quantile, Binomial(n, p), leaves with at most (1 - level)/2 on either side (Conover, Practical Nonparametric
/// Statistics, 3.2). An end that n values cannot give is NaN.
Interval quantile_interval(std::span<const double> sorted, double p, double level = 0.95);

}  // namespace fatmc
