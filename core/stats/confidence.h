// Confidence regions of frequency response estimates.
//
// With G complex normal of variance s^2 and an independent estimate of s^2 from q complex degrees of freedom,
// |G - G0|^2 / s^2 follows F(2, 2q) (T 2.206, 2.207; there 2M - 2 = 2q, so M = q + 1). For a first parameter
// of two the distribution has a closed form, exact for every q > 0:
//
//   F(x; 2, 2q)    = 1 - (1 + x/q)^(-q)
//   F^-1(p; 2, 2q) = q ((1 - p)^(-1/q) - 1)
#pragma once

namespace fatmc {

/// P(F <= x) for F(2, 2q); 0 for x <= 0. q > 0.
double f_cdf_2_2q(double x, double q);

/// Quantile of F(2, 2q), 0 <= p <= 1 (infinite at 1). q > 0.
double f_quantile_2_2q(double p, double q);

/// Quantile of F(d1, d2) in general, 0 < p < 1, degrees of freedom above 0 (real ones: a complex degree
/// counts twice).
double f_quantile(double p, double d1, double d2);

/// Radius of the disc that holds an element with probability p: sqrt(variance F^-1(p; 2, 2q))
/// (T 2.207, 5.11).
double confidence_radius(double variance, double p, double q);

/// Level of each of `count` regions so that together they hold with at least `p` (Bonferroni): 1 - (1 -
/// p)/count.
double bonferroni_level(double p, int count);

/// Confidence of a disc of radius kappa sigma: 1 - (1 + kappa^2/q)^(-q) (T 2.266).
double confidence_of_radius(double kappa, double q);

}  // namespace fatmc
