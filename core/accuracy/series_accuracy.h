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

/// Over all outputs, the geometric mean prod d_i^(w_i / n) with weights of 1 (H 11). At least one index.
double overall_index_of_agreement(std::span<const double> indices);

}  // namespace fatmc
