#include "core/stats/empirical.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"

namespace fatmc {

double sample_quantile(std::span<double> values, double p) {
  FATMC_CHECK(!values.empty() && p >= 0.0 && p <= 1.0, "values and a probability");
  const double h = p * static_cast<double>(values.size() - 1);
  const auto i = static_cast<std::size_t>(h);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(i);
  std::nth_element(values.begin(), at, values.end());
  const double share = h - static_cast<double>(i);
  if (share == 0.0 || i + 1 >= values.size()) return *at;
  const double next = *std::min_element(at + 1, values.end());
  return *at == next ? *at : *at + share * (next - *at);  // equal infinities have no difference
}

EmpiricalCdf::EmpiricalCdf(std::vector<double> values) : values_(std::move(values)) {
  FATMC_CHECK(!values_.empty(), "at least one value");
  for (const double v : values_) FATMC_CHECK(std::isfinite(v), "finite values");
  std::sort(values_.begin(), values_.end());
}

double EmpiricalCdf::operator()(double x) const {
  const auto below = std::upper_bound(values_.begin(), values_.end(), x) - values_.begin();
  return static_cast<double>(below) / static_cast<double>(values_.size());
}

double EmpiricalCdf::quantile(double p) const {
  FATMC_CHECK(p >= 0.0 && p <= 1.0, "a probability");
  const double h = p * static_cast<double>(values_.size() - 1);
  const auto i = static_cast<std::size_t>(h);
  if (i + 1 >= values_.size()) return values_.back();
  return values_[i] + (h - static_cast<double>(i)) * (values_[i + 1] - values_[i]);
}

double EmpiricalCdf::distance(const std::function<double(double)>& cdf) const {
  const double n = static_cast<double>(values_.size());
  double distance = 0.0;
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const double f = cdf(values_[i]);
    distance = std::max({distance, static_cast<double>(i + 1) / n - f, f - static_cast<double>(i) / n});
  }
  return distance;
}

}  // namespace fatmc
