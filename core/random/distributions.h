// Draws from the laws that parameters are dispersed by.
//
// Each takes its numbers from one stream and nothing else; how many it takes may vary from draw to draw.
#pragma once

#include <vector>

#include "core/random/random_stream.h"

namespace fatmc {

/// Uniform on [low, high).
double draw_uniform(RandomStream& stream, double low, double high);

/// Mean and standard deviation; sd >= 0.
double draw_normal(RandomStream& stream, double mean, double sd);

/// The normal law of `mean` and `sd` (those of the whole law, not of what is left) given that low <= x <=
/// high, by inversion of its distribution function from the tail that keeps all digits. sd > 0, low < high;
/// one uniform number.
double draw_truncated_normal(RandomStream& stream, double mean, double sd, double low, double high);
/// P(low <= x <= high) of the whole law; a draw needs it above 0.
double normal_probability(double mean, double sd, double low, double high);

/// exp of a normal law: median, and standard deviation of the natural logarithm. median > 0, log_sd >= 0.
double draw_log_normal(RandomStream& stream, double median, double log_sd);

/// Factor of a correlation matrix, C = L Lᵀ with L lower triangular, row by row. Positive semidefinite
/// matrices are taken (a pivot below 1e-10 counts as 0). Empty when C is not symmetric within 1e-12, has a
/// diagonal other than 1, or is not positive semidefinite.
std::vector<std::vector<double>> correlation_factor(const std::vector<std::vector<double>>& correlation);

/// x = mean + diag(sd) L z, z independent standard normal.
std::vector<double> draw_correlated(RandomStream& stream, const std::vector<double>& mean,
                                    const std::vector<double>& sd,
                                    const std::vector<std::vector<double>>& factor);

}  // namespace fatmc
