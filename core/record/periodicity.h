// What a periodic excitation tells about itself: its period and its lines.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace fatmc {

/// Mean square of x[n+period] - x[n] over twice the variance, the mean over channels: 0 for exact repetition, about
/// 1 for unrelated samples, 1/SNR of a periodic signal in noise. `x`: samples x channels, none constant.
double repetition_error(const Eigen::Ref<const Eigen::MatrixXd>& x, int period);

/// The shortest period after which the channels repeat (up to noise of 5 % of their variance), of at most half the
/// record; 0 where there is none. Any length is found, divisor of the record or not.
int find_period(const Eigen::Ref<const Eigen::MatrixXd>& x);

/// Harmonics of one period that are excited: those above the widest step, of at least a factor 5, in the sorted
/// magnitudes of the mean spectrum over all periods (of each channel relative to its largest line; the largest over
/// channels counts), with at least 8 lines below it unless they are all below 1e-5 of the largest; such lines are never excited.
/// Fails where no such step exists, as where every line is excited.
Result<std::vector<int>> find_excited_lines(const Eigen::Ref<const Eigen::MatrixXd>& x, int period);

}  // namespace fatmc
