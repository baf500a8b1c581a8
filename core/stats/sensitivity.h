// Which of several random inputs drives an output, from given trials: rank correlations and first-order
// variance shares.
//
// Rank correlation (Spearman): Pearson's correlation of average ranks; monotonic influence and its sign.
// Interval by Fisher's z with the variance (1 + rho²/2)/(n - 3) of Bonett and Wright (2000).
//
// First-order share: S = Var E[y | x] / Var y, what of the output's variance would vanish in the mean if x
// were known. E[y | x] is estimated by least squares on Legendre polynomials of the rank of x (the rank is
// uniform whatever x's law, so that one basis serves all laws and outliers of x do not matter), of degree
// min(8, n/8). The share is the adjusted coefficient of determination, 1 - (RSS/(n-d-1))/(TSS/(n-1)), whose
// expectation is 0 for an x without influence (a plain one would be d/(n-1)). Interval by bootstrap over
// trials: in the bootstrap's world the sample is the population, whose share is the plain coefficient R², so
// that S* scatters about R² and not about S; the interval is the percentiles of S* moved by S - R². (The
// reflected form, S - (S* - R²), held 90 % instead of 95 in simulations, this one 93 to 96: it follows the
// skewness of a coefficient of determination. tests/statistical/sensitivity_interval_test.cc.) Shares of
// independent inputs add up to at most 1; what is missing is interaction, influence finer than the
// polynomial, and the noise of the trials. Shares of correlated inputs overlap.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/stats/intervals.h"

namespace fatmc {

/// 1 ... n, equal values sharing the mean of their ranks. Finite values.
std::vector<double> average_ranks(std::span<const double> values);

struct Estimate {
  double value = 0.0;
  Interval interval;
};

/// None for n < 4, or where x or y is constant.
std::optional<Estimate> rank_correlation(std::span<const double> x, std::span<const double> y,
                                         double level = 0.95);

struct ShareOptions {
  double level = 0.95;
  int resamples = 500;
  std::uint64_t seed = 0;  ///< of the bootstrap: the same trials give the same interval
};

/// The interval is cut to [0, 1], the value is not: just below 0 it says "none". None for n < 25, or where x
/// or y is constant.
std::optional<Estimate> first_order_share(std::span<const double> x, std::span<const double> y,
                                          const ShareOptions& options = {});

/// Degree of the polynomial for n trials.
int share_degree(std::size_t n);

}  // namespace fatmc
