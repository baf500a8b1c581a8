#include "campaigns/base/figure.h"

#include <algorithm>
#include <cmath>

#include "core/stats/empirical.h"

namespace fatmc::plot {

std::optional<Boxes::Box> box_of(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return std::nullopt;
  const EmpiricalCdf sample(std::move(values));
  Boxes::Box box;
  box.lower_quartile = sample.quantile(0.25);
  box.median = sample.quantile(0.5);
  box.upper_quartile = sample.quantile(0.75);
  const double reach = 1.5 * (box.upper_quartile - box.lower_quartile);
  box.low_whisker = box.lower_quartile;
  box.high_whisker = box.upper_quartile;
  for (const double value : sample.sorted()) {
    if (value < box.lower_quartile - reach || value > box.upper_quartile + reach) {
      box.outliers.push_back(value);
    } else {
      box.low_whisker = std::min(box.low_whisker, value);
      box.high_whisker = std::max(box.high_whisker, value);
    }
  }
  return box;
}

}  // namespace fatmc::plot
