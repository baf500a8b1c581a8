#include "core/stats/confidence_sequence.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/check.h"

namespace fatmc {

ConfidenceSequence::ConfidenceSequence(const ConfidenceSequenceOptions& options) : options_(options) {
  FATMC_CHECK(options.level > 0.0 && options.level < 1.0, "a level between 0 and 1");
  FATMC_CHECK(options.low < options.high && options.tuned_for > 0.0, "bounds and a size");
  const double infinity = std::numeric_limits<double>::infinity();
  interval_ = options.kind == ConfidenceSequenceOptions::Kind::bernstein ? Interval{options.low, options.high}
                                                                         : Interval{-infinity, infinity};
}

void ConfidenceSequence::add(double value) {
  FATMC_CHECK(std::isfinite(value), "a finite value");
  ++n_;
  const double before = value - mean_;
  mean_ += before / static_cast<double>(n_);
  squares_ += before * (value - mean_);
  if (options_.kind == ConfidenceSequenceOptions::Kind::normal) return renew_normal();
  FATMC_CHECK(value >= options_.low && value <= options_.high, "a value inside the bounds");
  add_bernstein((value - options_.low) / (options_.high - options_.low));
}

void ConfidenceSequence::add_bernstein(double x) {
  const double i = static_cast<double>(n_);
  const double log_term = std::log(2.0 / (1.0 - options_.level));
  const double plug_mean = plug_sum_ / i;  // (1/2 + sum of i - 1 values) / i
  const double plug_variance = plug_squares_ / i;
  const double lambda = std::min(0.5, std::sqrt(2.0 * log_term / (plug_variance * i * std::log1p(i))));
  weight_ += lambda;
  weighted_ += lambda * x;
  penalty_ += (x - plug_mean) * (x - plug_mean) * (-std::log1p(-lambda) - lambda);
  plug_sum_ += x;
  const double renewed = plug_sum_ / (i + 1.0);
  plug_squares_ += (x - renewed) * (x - renewed);
  const double centre = weighted_ / weight_, half = (log_term + penalty_) / weight_;
  const double span = options_.high - options_.low;
  const double low = std::max(interval_.low, options_.low + span * (centre - half));
  const double high = std::min(interval_.high, options_.low + span * (centre + half));
  // An empty intersection happens with probability below alpha: the interval that was stays.
  if (low <= high) interval_ = {low, high};
}

void ConfidenceSequence::renew_normal() {
  if (n_ < 2) return;
  const double n = static_cast<double>(n_);
  const double alpha = 1.0 - options_.level;
  const double g = (-2.0 * std::log(alpha) + std::log1p(-2.0 * std::log(alpha))) / options_.tuned_for;
  const double big = 1.0 + n * g;
  const double r = std::exp((std::log(big) - 2.0 * std::log(alpha)) / n);
  if (r >= big) return;  // nothing can be said yet
  const double deviation = std::sqrt(squares_ / (n - 1.0));
  const double half = deviation * std::sqrt((n - 1.0) / n * (r - 1.0) / (1.0 - r / big));
  interval_ = {mean_ - half, mean_ + half};
}

}  // namespace fatmc
