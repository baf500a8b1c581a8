// Where a value lies on a drawn axis, and at which values it has ticks.
#pragma once

#include <string>
#include <vector>

#include "campaigns/base/figure.h"

namespace fatmc::plot {

/// Round values (1, 2 or 5 times a power of ten apart) inside the range, about `count` of them.
std::vector<double> linear_ticks(const Range& range, int count);

/// Powers of ten inside the range; where there are fewer than three, 1, 2 and 5 times powers of ten; 1, 2, 3, 4, 5, 6 and 8
/// times where `count` has room for all of them. Fewer than two: linear ticks.
std::vector<double> logarithmic_ticks(const Range& range, int count);

/// The tick's text: evenly spaced ticks have as many decimals as their spacing, others as many as they need.
std::string tick_text(double value, const std::vector<double>& ticks);

/// Maps values of an axis to pixels: `range.low` to `first_px`, `range.high` to `last_px`.
class AxisScale {
 public:
  AxisScale(const Axis& axis, const Range& range, double first_px, double last_px);

  /// The pixel, not finite where the value has no place on the axis.
  [[nodiscard]] double pixel(double value) const;
  [[nodiscard]] const std::vector<double>& ticks() const { return ticks_; }
  /// One a tick: its number, or the axis' own label.
  [[nodiscard]] const std::vector<std::string>& texts() const { return texts_; }
  /// Values of the fine grid between the ticks: 2 ... 9 times powers of ten on a logarithmic axis of one to
  /// four decades.
  [[nodiscard]] const std::vector<double>& fine_grid() const { return fine_grid_; }
  [[nodiscard]] const Range& range() const { return range_; }

 private:
  Scale scale_;
  Range range_;
  double first_px_, last_px_;
  std::vector<double> ticks_, fine_grid_;
  std::vector<std::string> texts_;
};

/// What the marks of a panel span along x (or y), or the axis' own range: never empty, with 5 % to spare
/// along a linear y.
Range axis_range(const Panel& panel, bool vertical);

}  // namespace fatmc::plot
