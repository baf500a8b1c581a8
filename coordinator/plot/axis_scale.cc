#include "coordinator/plot/axis_scale.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/check.h"
#include "core/base/text.h"

namespace fatmc::plot {
namespace {

double nice_step(double span, int count) {
  const double raw = span / std::max(1, count);
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw * (1.0 - 1e-9)) return factor * power;
  }
  return 10.0 * power;
}

/// Multiples of powers of ten inside the range.
std::vector<double> multiples(const Range& range, std::initializer_list<int> factors) {
  std::vector<double> out;
  const int first = static_cast<int>(std::floor(std::log10(range.low))),
            last = static_cast<int>(std::floor(std::log10(range.high)));
  for (int power = first; power <= last; ++power) {
    for (const int factor : factors) {
      // Division keeps 0.1 and its like the nearest double to their text.
      const double value = power < 0 ? factor / std::pow(10.0, -power) : factor * std::pow(10.0, power);
      if (value >= range.low * (1.0 - 1e-12) && value <= range.high * (1.0 + 1e-12)) out.push_back(value);
    }
  }
  return out;
}

class Extent {
 public:
  explicit Extent(Scale scale) : positive_(scale == Scale::logarithmic) {}
  void add(double value) {
    if (!std::isfinite(value) || (positive_ && value <= 0.0)) return;
    low_ = std::min(low_, value);
    high_ = std::max(high_, value);
  }
  void add(const std::vector<double>& values) {
    for (const double value : values) add(value);
  }
  [[nodiscard]] Range range(double margin) const {
    if (low_ > high_) return positive_ ? Range{1.0, 10.0} : Range{0.0, 1.0};
    if (positive_) return low_ < high_ ? Range{low_, high_} : Range{low_ / 2.0, high_ * 2.0};
    if (low_ == high_)
      return {low_ - std::max(1.0, std::abs(low_)) / 2.0, high_ + std::max(1.0, std::abs(high_)) / 2.0};
    const double spare = margin * (high_ - low_);
    return {low_ - spare, high_ + spare};
  }

 private:
  bool positive_;
  double low_ = std::numeric_limits<double>::infinity(), high_ = -std::numeric_limits<double>::infinity();
};

/// Adds what a mark spans along one axis.
struct Spanned {
  Extent& extent;
  bool vertical;

  void operator()(const Line& m) const { extent.add(vertical ? m.y : m.x); }
  void operator()(const Points& m) const { extent.add(vertical ? m.y : m.x); }
  void operator()(const Band& m) const {
    extent.add(vertical ? m.low : m.x);
    if (vertical) extent.add(m.high);
  }
  void operator()(const Boxes& m) const {
    for (const double x : m.x) {
      if (vertical) break;
      extent.add(m.low_edge(x));
      extent.add(m.high_edge(x));
    }
    for (const Boxes::Box& box : m.boxes) {
      if (!vertical) break;
      extent.add(box.low_whisker);
      extent.add(box.high_whisker);
      extent.add(box.outliers);
    }
  }
  void operator()(const Bars& m) const {
    extent.add(vertical ? m.heights : m.edges);
    if (vertical) extent.add(0.0);
  }
  void operator()(const Rule&) const {}
  void operator()(const Cells& m) const {
    for (const double place : vertical ? m.y : m.x) {
      extent.add(place - 0.5);
      extent.add(place + 0.5);
    }
  }
};

}  // namespace

std::vector<double> linear_ticks(const Range& range, int count) {
  FATMC_CHECK(range.low < range.high, "a range");
  const double step = nice_step(range.high - range.low, count);
  std::vector<double> out;
  for (double k = std::ceil(range.low / step - 1e-9); k <= range.high / step + 1e-9; k += 1.0) {
    out.push_back(k == 0.0 ? 0.0 : k * step);
  }
  return out;
}

std::vector<double> logarithmic_ticks(const Range& range, int count) {
  FATMC_CHECK(range.low > 0.0 && range.low < range.high, "a positive range");
  std::vector<double> out = multiples(range, {1});
  if (out.size() < 3) out = multiples(range, {1, 2, 5});
  // A wide axis over a decade has room for more.
  if (auto more = multiples(range, {1, 2, 3, 4, 5, 6, 8}); static_cast<int>(more.size()) <= count)
    out = std::move(more);
  if (out.size() < 2) return linear_ticks(range, count);
  while (static_cast<int>(out.size()) > 2 * count) {  // every second decade of many
    for (std::size_t k = 1; k < out.size(); ++k) out.erase(out.begin() + static_cast<std::ptrdiff_t>(k));
  }
  return out;
}

std::string tick_text(double value, const std::vector<double>& ticks) {
  if (value == 0.0) return "0";
  bool even = ticks.size() > 1;
  for (std::size_t k = 2; k < ticks.size(); ++k) {
    even = even && std::abs((ticks[k] - ticks[k - 1]) / (ticks[1] - ticks[0]) - 1.0) < 1e-6;
  }
  if (!even || std::abs(value) >= 1e5) return significant(value, 6);
  const double decimals = -std::floor(std::log10(ticks[1] - ticks[0]) + 1e-9);
  return decimals > 5.0 ? significant(value, 6) : fixed(value, std::max(0, static_cast<int>(decimals)));
}

AxisScale::AxisScale(const Axis& axis, const Range& range, double first_px, double last_px)
    : scale_(axis.scale), range_(range), first_px_(first_px), last_px_(last_px) {
  const double apart = last_px > first_px ? 55.0 : 26.0;  // upwards, a text needs its height alone
  const int count = std::max(2, static_cast<int>(std::abs(last_px - first_px) / apart));
  if (scale_ == Scale::linear) {
    ticks_ = linear_ticks(range, count);
  } else {
    ticks_ = logarithmic_ticks(range, count);
    const double decades = std::log10(range.high / range.low);
    if (decades >= 0.5 && decades <= 4.0) fine_grid_ = multiples(range, {2, 3, 4, 5, 6, 7, 8, 9});
  }
  const bool named = !axis.tick_labels.empty();
  FATMC_CHECK(!named || axis.tick_labels.size() == axis.ticks.size(), "a label a tick");
  if (!axis.ticks.empty()) ticks_.clear();
  for (std::size_t k = 0; k < axis.ticks.size(); ++k) {
    if (axis.ticks[k] < range.low || axis.ticks[k] > range.high) continue;
    ticks_.push_back(axis.ticks[k]);
    if (named) texts_.push_back(axis.tick_labels[k]);
  }
  if (named) return;
  for (const double tick : ticks_) texts_.push_back(tick_text(tick, ticks_));
}

double AxisScale::pixel(double value) const {
  double share = (value - range_.low) / (range_.high - range_.low);
  if (scale_ == Scale::logarithmic) {
    if (!(value > 0.0)) return std::numeric_limits<double>::quiet_NaN();
    share = std::log(value / range_.low) / std::log(range_.high / range_.low);
  }
  return first_px_ + share * (last_px_ - first_px_);
}

Range axis_range(const Panel& panel, bool vertical) {
  const Axis& axis = vertical ? panel.y : panel.x;
  if (axis.range) {
    FATMC_CHECK(axis.range->low < axis.range->high && (axis.scale == Scale::linear || axis.range->low > 0.0),
                "a range of the axis");
    return *axis.range;
  }
  Extent extent(axis.scale);
  for (const Mark& mark : panel.marks) std::visit(Spanned{extent, vertical}, mark);
  return extent.range(vertical ? 0.05 : 0.0);
}

}  // namespace fatmc::plot
