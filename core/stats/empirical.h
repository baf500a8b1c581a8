// Empirical distributions.
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace fatmc {

/// EmpiricalCdf::quantile of a sample used once: linear in its size; reorders `values` (at least one, no NaN).
double sample_quantile(std::span<double> values, double p);

class EmpiricalCdf {
 public:
  /// Takes finite values in any order; at least one.
  explicit EmpiricalCdf(std::vector<double> values);

  /// Share of values <= x.
  [[nodiscard]] double operator()(double x) const;
  /// Quantile by linear interpolation between order statistics, h = (n - 1) p (type 7); 0 <= p <= 1.
  [[nodiscard]] double quantile(double p) const;
  /// Kolmogorov-Smirnov distance to a continuous distribution function: sup |F_n(x) - F(x)|.
  [[nodiscard]] double distance(const std::function<double(double)>& cdf) const;
  [[nodiscard]] std::span<const double> sorted() const { return values_; }

 private:
  std::vector<double> values_;
};

}  // namespace fatmc
