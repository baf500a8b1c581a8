// Modes of a continuous model: period, damping, and how much of one response they make up.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <optional>
#include <span>
#include <vector>

#include "core/base/error.h"
#include "core/subspace/discrete_model.h"

namespace fatmc {

/// A real eigenvalue, or a pair by the one with the positive imaginary part.
struct Mode {
  std::complex<double> s;  ///< rad/s

  [[nodiscard]] bool oscillatory() const { return s.imag() > 0.0; }
  /// T_P = 2 pi / Im s: the time between two crests of a response. H does not say whether it means this or
  /// 2 pi / |s|; they differ by 23 % at D = 0.58, by less than 6 % up to D = 0.32.
  [[nodiscard]] double period_s() const;
  /// D = -Re s / |s|.
  [[nodiscard]] double damping() const;
};

/// The pair of that period and damping, |damping| < 1.
Mode mode_of(double period_s, double damping);

/// Ascending by |s|. Fails where A is not finite.
Result<std::vector<Mode>> modes_of(const Eigen::Ref<const Eigen::MatrixXd>& a);

/// The oscillatory mode nearest to `wanted` in |s - s_wanted| / |s_wanted|; none where that exceeds `within`.
std::optional<Mode> nearest_mode(std::span<const Mode> modes, const Mode& wanted, double within);

/// A mode as it shows in one element of the transfer matrix.
struct ModeShare {
  Mode mode;
  double peak = 0.0;  ///< |residue| / |Re s|, that pole's own height on the imaginary axis
  /// Of the largest such peak among the oscillatory modes; a near-integrator's would hide them all. 1 where none oscillates.
  double share = 0.0;
};

/// Poles that zeros cancel have a small share: the reduction to a single-loop transfer function of H 5.2.
/// Fails where A is not finite or has no basis of eigenvectors.
Result<std::vector<ModeShare>> mode_shares(const ContinuousModel& model, Eigen::Index output,
                                           Eigen::Index input);

/// C e^(At) B of that element at the given times, s: the response to an impulse of area 1. Fails as mode_shares does.
Result<std::vector<double>> impulse_response(const ContinuousModel& model, Eigen::Index output,
                                             Eigen::Index input, std::span<const double> times_s);

}  // namespace fatmc
