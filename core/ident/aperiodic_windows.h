// Windows of consecutive DFT bins, for estimators that take a record as it is: arbitrary excitation, no
// period.
#pragma once

#include <algorithm>
#include <vector>

#include "core/base/error.h"
#include "core/ident/measurement.h"

namespace fatmc {

/// Bins first ... last of the DFT over the whole record; every one is a line of the estimate.
struct BinBand {
  int first = 1, last = 0;

  [[nodiscard]] int count() const { return last - first + 1; }
  /// First bin of the window of `width` bins about `bin`, shifted at the ends.
  [[nodiscard]] int window(int bin, int width) const {
    return std::clamp(bin - width / 2, first, last - width + 1);
  }
};

/// From the first excited bin to the last where the record knows its lines; else all between 0 and half the
/// rate. Within the measurement's low_hz and high_hz. Fails where the band is narrower than `width`.
Result<BinBand> bin_band(const Measurement& m, int width);

/// The bins of `band`, of a DFT over `samples`, that lie between the measurement's low_hz and high_hz.
BinBand within_limits(const BinBand& band, const Measurement& m, int samples);

/// Zero in place of what lies 160 dB below a column's largest bin: rounding of the DFT or of the file, not an excitation.
/// Regressors are scaled to length 1, so that rounding alone would pass for a signal; zeros make such a line singular.
void drop_rounding(Eigen::Ref<Eigen::MatrixXcd> known);

/// An estimate's head for every bin of the band: lines, frequencies, sizes, border lines.
void begin_estimate(const Measurement& m, const BinBand& band, int width, FrmEstimate& estimate);

}  // namespace fatmc
