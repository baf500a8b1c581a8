#include "core/ident/design_formulas.h"

#include <cmath>
#include <numbers>

#include "core/base/check.h"
#include "core/ident/interpolation_bias.h"

namespace fatmc {
namespace {

/// x of 1 - (1 + x^2)^(-1/2) = error.
double width_of(double error) {
  FATMC_CHECK(error > 0.0 && error < 1.0, "a share of the peak");
  return std::sqrt(1.0 / ((1.0 - error) * (1.0 - error)) - 1.0);
}

}  // namespace

double magnitude_bias_constant(int order) {
  FATMC_CHECK(order >= 0 && order % 2 == 0, "an even degree");
  const int n = order + 2;
  double coefficient = 1.0;  // binomial(n, n/2) / 2^n = prod (2i - 1)/(2i)
  for (int i = 1; i <= n / 2; ++i) coefficient *= (2.0 * i - 1.0) / (2.0 * i);
  return limit_bias_constant(order) * coefficient;
}

double required_line_spacing_hz(double b_3db_hz, int n_e, int order, double relative_bias) {
  FATMC_CHECK(b_3db_hz > 0.0 && n_e >= 1 && relative_bias > 0.0, "a mode, a window and a tolerance");
  const double exponent = order % 2 == 0 ? order + 2 : order + 1;
  return b_3db_hz / (2 * n_e + 1) * std::pow(relative_bias / limit_bias_constant(order), 1.0 / exponent);
}

int lines_each_side(int n_out, int m, int order, int n_in, int n_in_add) {
  return (n_out + m + (order + 1) * (n_in + n_in_add)) / 2;  // ceil((x - 1)/2) = floor(x/2)
}

double recommended_duration_s(double f0_hz, double damping, int order, DurationRule rule) {
  FATMC_CHECK(f0_hz > 0.0 && damping > 0.0, "a damped mode");
  const double factor = rule == DurationRule::table_3_1 ? 3.0 * std::numbers::pi : 2.0 * order + 3.0;
  return factor / (2.0 * damping * f0_hz);
}

double intergrid_damping_3db(double spacing_hz, double f0_hz) {
  FATMC_CHECK(spacing_hz > 0.0 && f0_hz > 0.0, "a spacing and a frequency");
  return spacing_hz / (2.0 * f0_hz);
}

double intergrid_error(double spacing_hz, double f0_hz, double damping) {
  FATMC_CHECK(damping > 0.0, "a damped mode");
  const double x = intergrid_damping_3db(spacing_hz, f0_hz) / damping;
  return 1.0 - 1.0 / std::sqrt(1.0 + x * x);
}

double intergrid_relative_spacing(double error, double damping) { return 2.0 * damping * width_of(error); }

double intergrid_covered_damping(double error, double spacing_hz, double f0_hz) {
  return intergrid_damping_3db(spacing_hz, f0_hz) / width_of(error);
}

}  // namespace fatmc
