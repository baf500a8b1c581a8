// Intervals for a mean that hold at all sample sizes at once: P(mean inside for every n) >= level, so that
// one may look after each trial and stop when the interval is narrow enough. (An ordinary 95 % interval
// looked at after each trial of a long campaign misses the mean at some time with a probability that tends to
// one.)
//
// Two kinds:
//
// bernstein: values in [low, high], otherwise of any law, conditionally on the past of one mean. With X
// scaled to [0, 1],
//   X_i - m_{i-1} >= -1 and 0 <= l_i < 1, both known before X_i,
//     exp(l_i (X_i - mu) - (X_i - m_{i-1})² (-log(1 - l_i) - l_i))
//   has expectation <= 1 (from exp(l x + x² (l + log(1 - l))) <= 1 + l x for x >= -1: Fan, Grama and Liu
//   2015, lemma 4.1), so that its products are a supermartingale and Ville's inequality gives, on each side
//   with alpha/2,
//     (sum l_i X_i ± (log(2/alpha) + sum (X_i - m_{i-1})² (-log(1 - l_i) - l_i))) / sum l_i.
//   l_i = min(1/2, sqrt(2 log(2/alpha) / (v_{i-1} i log(1 + i)))), m and v the mean and variance so far with
//   half a trial of prior (Waudby-Smith and Ramdas 2024, theorem 2: the predictable plug-in). Intersected
//   over n.
//
// normal: for normal values of unknown mean and variance. The t statistic's Bayes factor with a normal prior
// of variance
//   g on the effect size and the scale-invariant prior on the deviation is, for the mean tested, a martingale
//   (Lai 1976, Wang and Ramdas 2024), and inverting BF_n(mu) < 1/alpha gives with N = 1 + n g, r =
//   (sqrt(N)/alpha)^(2/n),
//     mean ± s sqrt((n - 1)/n (r - 1)/(1 - r/N)),      infinite while r >= N.
//   Exact at every n for normal values; for others only asymptotically, as n tends to the range where the
//   mean is normal (it then tends to Robbins' mixture with the deviation put in, Waudby-Smith et al. 2024):
//   choose `minimum` accordingly. tests/statistical/confidence_sequence_test.cc measures it for skewed
//   values. Not intersected over n. g = (-2 log alpha + log(1 - 2 log alpha)) / tuned_for makes the width
//   least near n = tuned_for.
#pragma once

#include <cstdint>

#include "core/stats/intervals.h"

namespace fatmc {

struct ConfidenceSequenceOptions {
  enum class Kind { bernstein, normal };
  Kind kind = Kind::normal;
  double level = 0.95;
  double low = 0.0, high = 1.0;  ///< bernstein: bounds of a value
  double tuned_for = 500.0;      ///< normal: see above
};

class ConfidenceSequence {
 public:
  explicit ConfidenceSequence(const ConfidenceSequenceOptions& options);

  /// The next value, in the order of the trials; finite, and inside the bounds for bernstein.
  void add(double value);

  [[nodiscard]] std::uint64_t count() const { return n_; }
  /// Of all values so far.
  [[nodiscard]] double mean() const { return mean_; }
  /// Infinite (normal) or the bounds (bernstein) before anything can be said. The middle of a Bernstein
  /// interval is a weighted mean, not mean().
  [[nodiscard]] Interval interval() const { return interval_; }
  [[nodiscard]] double half_width() const { return 0.5 * (interval_.high - interval_.low); }

 private:
  void add_bernstein(double x);
  void renew_normal();

  ConfidenceSequenceOptions options_;
  std::uint64_t n_ = 0;
  double mean_ = 0.0, squares_ = 0.0;  // Welford
  Interval interval_;
  // bernstein, in units of the bounds
  double weight_ = 0.0, weighted_ = 0.0, penalty_ = 0.0;
  double plug_sum_ = 0.5, plug_squares_ = 0.25;
};

}  // namespace fatmc
