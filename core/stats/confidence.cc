#include "core/stats/confidence.h"

#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>

#include "core/base/check.h"

namespace fatmc {

double f_cdf_2_2q(double x, double q) {
  FATMC_CHECK(q > 0.0, "degrees of freedom");
  return x <= 0.0 ? 0.0 : -std::expm1(-q * std::log1p(x / q));
}

double f_quantile_2_2q(double p, double q) {
  FATMC_CHECK(q > 0.0 && p >= 0.0 && p <= 1.0, "a probability and degrees of freedom");
  return q * std::expm1(-std::log1p(-p) / q);
}

double f_quantile(double p, double d1, double d2) {
  FATMC_CHECK(p > 0.0 && p < 1.0 && d1 > 0.0 && d2 > 0.0, "a probability and degrees of freedom");
  return boost::math::quantile(boost::math::fisher_f(d1, d2), p);
}

double confidence_radius(double variance, double p, double q) {
  FATMC_CHECK(variance >= 0.0, "a variance");
  return std::sqrt(variance * f_quantile_2_2q(p, q));
}

double bonferroni_level(double p, int count) {
  FATMC_CHECK(count >= 1, "at least one region");
  return 1.0 - (1.0 - p) / count;
}

double confidence_of_radius(double kappa, double q) { return f_cdf_2_2q(kappa * kappa, q); }

}  // namespace fatmc
