// What a subspace identification is given: maneuvers of the same channels and rate.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/base/error.h"

namespace fatmc {

/// One maneuver, sample by sample: samples x n_u and samples x n_y.
struct Maneuver {
  Eigen::MatrixXd inputs;
  Eigen::MatrixXd outputs;

  [[nodiscard]] Eigen::Index samples() const { return inputs.rows(); }
};

/// Which constant is taken off every channel of a maneuver: a linear model knows no trim.
enum class OffsetRemoval {
  none,
  mean,   ///< of the maneuver
  first,  ///< its first sample, for maneuvers that begin in trim
};

/// Takes the offsets off; returns them, one row of n_u + n_y values a maneuver.
Eigen::MatrixXd remove_offsets(std::span<Maneuver> maneuvers, OffsetRemoval removal);

/// The largest past window whose regression is not underdetermined: p n_z unknowns an output, sum (N_j - p)
/// equations,
///   p_max = floor(sum N_j / (n_u + n_y + J)),  J maneuvers.
/// H (4) prints a sum over j in the place of J.
int largest_past_window(std::span<const Maneuver> maneuvers);

/// At least one maneuver, each with the channels of the first, finite, no input or output dead in all of
/// them, no input a linear combination of the others; the error says which.
Status check_maneuvers(std::span<const Maneuver> maneuvers);

}  // namespace fatmc
