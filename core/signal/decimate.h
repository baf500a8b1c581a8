// A slower rate: low pass without delay, then every `factor`-th sample.
#pragma once

#include <Eigen/Core>

namespace fatmc {

/// Each column of `samples` through a symmetric windowed-sinc low pass (Hamming, 20 factor + 1 taps, unit
/// gain at f = 0, cut at 0.8 of the new Nyquist frequency), then every `factor`-th sample from the first on.
/// Linear phase, taken off: no delay. Ends are continued by reflection in their last value. `factor` >= 1; 1
/// returns the samples. At least 10 factor + 1 rows.
Eigen::MatrixXd decimate(const Eigen::Ref<const Eigen::MatrixXd>& samples, int factor);

}  // namespace fatmc
