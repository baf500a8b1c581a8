// Means, proportions and their intervals over independent runs.
#pragma once

#include <cstdint>
#include <span>

namespace fatmc {

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// Wilson's score interval for a proportion of `hits` in `n` independent trials; [0, 1] for n = 0.
/// Lines and elements of one run are not independent: count runs, or use mean_over_runs.
Interval proportion_interval(std::uint64_t hits, std::uint64_t n, double level = 0.95);

struct RunMean {
  std::uint64_t n = 0;
  double mean = 0.0;
  double deviation = 0.0;       ///< between runs, divisor n - 1; 0 for n < 2
  double standard_error = 0.0;  ///< deviation / sqrt(n)
};

/// One value a run (a proportion within the run, a median ...): the scatter between runs carries whatever
/// correlation there is inside a run.
RunMean mean_over_runs(std::span<const double> values);

/// Quantile of Student's t, 0 < p < 1. dof > 0.
double t_quantile(double p, double dof);

/// Interval for the expected mean: mean +- t(1 - alpha/2; n-1) deviation / sqrt(n) (T 2.187-2.188 with the
/// printed quantile (1 - alpha)/2 corrected). Infinite for n < 2.
Interval mean_interval(const RunMean& runs, double level = 0.95);

/// Interval that holds the mean of `m` further runs, here a published campaign's:
/// mean +- t(1 - alpha/2; n-1) deviation sqrt(1/n + 1/m). Infinite for n < 2; m >= 1.
Interval prediction_interval(const RunMean& runs, std::uint64_t m, double level = 0.95);

}  // namespace fatmc
