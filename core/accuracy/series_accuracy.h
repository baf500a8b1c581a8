// How well a simulated time series stands for a measured one.
#pragma once

#include <optional>
#include <span>

namespace fatmc {

/// Theil's inequality coefficient: rms(m - y) / (rms(m) + rms(y)), 0 (equal) ... 1. Not corrected for offsets: the same
/// constant added to both changes it. None where both series are zero. Equal lengths, at least one sample.
std::optional<double> theil_coefficient(std::span<const double> measured, std::span<const double> simulated);

/// Index of agreement d_1 = 1 - sum |m_k - y_k| / sum (|m_k - mean m| + |y_k - mean m|), 1 (equal) ... 0. H (10) prints
/// the ratio itself, which is 0 for a perfect match, against its own text. None where both are constant at mean m.
std::optional<double> index_of_agreement(std::span<const double> measured, std::span<const double> simulated);

/// Over all n outputs, prod d_i^(w_i / n), H (11): the geometric mean where all weights are 1, as where none are given. Weights
/// are 0 (the output does not count, even at d_i = 0) or more, one an output. As printed, they are not divided by their sum: the
/// product keeps the scale of a mean, and with it the meaning of H's ratings, where they add up to n. At least one index.
double overall_index_of_agreement(std::span<const double> indices, std::span<const double> weights = {});

}  // namespace fatmc
