#include "core/ident/interpolation_bias.h"

#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include "core/base/check.h"

namespace fatmc {
namespace {

/// |g2 / g0| of every element over line k's window, in Hz^-2.
void curvature(const LpmGrid& grid, const FrmEstimate& estimate, int k, std::vector<double>& g0,
               std::vector<double>& g2, double* ratio) {
  const int elements = estimate.n_out * estimate.n_in;
  g0.assign(static_cast<std::size_t>(2 * elements), 0.0);
  g2.assign(static_cast<std::size_t>(2 * elements), 0.0);
  const auto constant = grid.constant_row(k);
  const auto quadratic = grid.quadratic_row(k);
  for (std::size_t w = 0; w < constant.size(); ++w) {
    const auto* g = reinterpret_cast<const double*>(estimate.G.data(grid.first(k) + static_cast<int>(w)));
    for (std::size_t e = 0; e < g0.size(); ++e) {
      g0[e] += constant[w] * g[e];
      g2[e] += quadratic[w] * g[e];
    }
  }
  for (int e = 0; e < elements; ++e) {
    const auto i = static_cast<std::size_t>(2 * e);
    const double a = std::hypot(g0[i], g0[i + 1]);
    ratio[e] = a > 0.0 ? std::hypot(g2[i], g2[i + 1]) / a : 0.0;
  }
}

/// (B_lpm / 2)^E in Hz^E.
double window_power(const LpmGrid& grid, int k) {
  const auto offsets = grid.offsets_hz(k);
  const double b_lpm = (offsets.back() - offsets.front()) * grid.window() / (grid.window() - 1);
  return std::pow(0.5 * b_lpm, grid.bias_exponent());
}

/// sum s_i d_i^E in Hz^E, exactly or as alpha (B_lpm / 2)^E.
double moment(const LpmGrid& grid, int k, BiasConstant constant) {
  if (constant == BiasConstant::exact_offsets) return grid.bias_moment(k);
  return named_bias_constant(constant, grid.options().order) * window_power(grid, k);
}

double binomial(int n, int k) {
  double value = 1.0;
  for (int i = 1; i <= k; ++i) value = value * (n - k + i) / i;
  return value;
}

}  // namespace

double limit_bias_constant(int order) {
  FATMC_CHECK(order >= 0, "a degree");
  const int n = order % 2 == 0 ? order + 2 : order + 1;
  return binomial(n, n / 2) / binomial(2 * n, n);
}

std::optional<double> printed_bias_constant(int order) {
  switch (order) {
    case 2: return 0.0857;
    case 4: return 8.65e-6;
    case 6: return 4.86e-9;
    default: return std::nullopt;
  }
}

double named_bias_constant(BiasConstant constant, int order) {
  if (constant == BiasConstant::limit) return limit_bias_constant(order);
  const std::optional<double> printed = printed_bias_constant(order);
  FATMC_CHECK(constant == BiasConstant::printed && printed.has_value(), "Table 2-3 has orders 2, 4 and 6");
  return *printed;
}

MatrixStack<double> interpolation_bias(const LpmGrid& grid, const FrmEstimate& estimate, BiasConstant constant) {
  FATMC_CHECK(grid.line_count() == estimate.line_count(), "the grid behind the estimate");
  const int elements = estimate.n_out * estimate.n_in;
  MatrixStack<double> bias(estimate.n_out, estimate.n_in, estimate.line_count());
  std::vector<double> g0, g2;
  for (int k = 0; k < estimate.line_count(); ++k) {
    double* b = bias.data(k);
    curvature(grid, estimate, k, g0, g2, b);
    const double sum = moment(grid, k, constant);
    const int half_exponent = grid.bias_exponent() / 2;  // (2 / B_3dB)^2 = |g2 / g0| / kThreeDbDrop
    for (int e = 0; e < elements; ++e) {
      double power = sum;
      for (int i = 0; i < half_exponent; ++i) power *= b[e] / kThreeDbDrop;
      b[e] = power * std::abs(estimate.G.data(k)[e]);
    }
  }
  return bias;
}

double bias_constant(const LpmGrid& grid, int k, BiasConstant constant) {
  if (constant == BiasConstant::exact_offsets) return grid.bias_moment(k) / window_power(grid, k);
  return named_bias_constant(constant, grid.options().order);
}

MatrixStack<double> three_db_range_hz(const LpmGrid& grid, const FrmEstimate& estimate, ThreeDbRule rule) {
  FATMC_CHECK(grid.line_count() == estimate.line_count(), "the grid behind the estimate");
  const int elements = estimate.n_out * estimate.n_in;
  MatrixStack<double> range(estimate.n_out, estimate.n_in, estimate.line_count());
  for (int k = 0; k < estimate.line_count(); ++k) {
    const auto rows = {grid.constant_row(k), grid.linear_row(k), grid.quadratic_row(k)};
    for (int e = 0; e < elements; ++e) {
      std::complex<double> psi[3];
      auto* term = psi;
      for (const auto& row : rows) {
        for (std::size_t w = 0; w < row.size(); ++w) {
          *term += row[w] * estimate.G.data(grid.first(k) + static_cast<int>(w))[e];
        }
        ++term;
      }
      const std::complex<double> linear = rule == ThreeDbRule::linear_kept ? psi[1] : 0.0;
      const double root = std::abs(std::sqrt(linear * linear - 4.0 * kThreeDbDrop * psi[0] * psi[2]));
      range.data(k)[e] = std::abs(psi[2]) > 0.0 ? root / std::abs(psi[2]) : std::numeric_limits<double>::infinity();
    }
  }
  return range;
}

}  // namespace fatmc
