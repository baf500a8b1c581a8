// Prediction of the smallest of m further values from n known ones, all independent and of one continuous law.
//
// From ranks alone (David & Nagaraja, Order Statistics, 2003, 7.3). All m further values exceed the j-th smallest x_(j) of the n
// exactly if the first j of the n + m in order are known ones, and every choice of ranks is as likely:
//
//   P(min > x_(j)) = C(n + m - j, m) / C(n + m, m) = prod_{i<j} (n - i)/(n + m - i)
//
// whatever the law. With j = 1 that is n/(n + m): x_(1) is a lower end at 97.5 % only from n = 39 m on. Of 50 values no
// statistic bounds the smallest of 50 others from below without a law; a bootstrap pretends to (it never leaves what it has
// seen: for 50 of 50 its 95 % hold 66 to 75 %, campaigns/coverage/README.md).
//
// Of normal values, ends mean + k s with mean and deviation s of the n: with z = (mean - mu)/sigma ~ N(0, 1/n) and
// w^2 = s^2/sigma^2 ~ chi^2_{n-1}/(n - 1), independent,
//
//   P(min > mean + k s) = E [1 - Phi(z + k w)]^m
//
// (the one-sided factor for all of m future observations: Hahn & Meeker, Statistical Intervals, 1991, 4.8).
#pragma once

#include <cstdint>
#include <span>

#include "core/stats/intervals.h"

namespace fatmc {

/// Ends beyond which the smallest of m further values lies with at most (1 - level)/2 each: -infinity and +infinity where
/// n values allow none. Exact for a continuous law, conservative by the steps of the ranks.
Interval smallest_prediction(std::span<const double> values, std::uint64_t m, double level = 0.95);

/// The same for normal values; n < 2: infinite. The factors are integrated to 2e-3.
Interval normal_smallest_prediction(std::span<const double> values, std::uint64_t m, double level = 0.95);

/// k with P(min > mean + k s) = p, 0 < p < 1, n >= 2.
double normal_smallest_factor(std::uint64_t n, std::uint64_t m, double p);

}  // namespace fatmc
