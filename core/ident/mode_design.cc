#include "core/ident/mode_design.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "core/base/check.h"
#include "core/ident/design_formulas.h"
#include "core/ident/interpolation_bias.h"

namespace fatmc {

ModeRequirement mode_requirement(const Mode& mode, int n_e, int order, double relative_bias) {
  FATMC_CHECK(mode.f0_hz > 0.0 && mode.damping > 0.0, "a damped mode");
  ModeRequirement out;
  out.b_3db_hz = 2.0 * mode.damping * mode.f0_hz;
  out.duration_table_s = recommended_duration_s(mode.f0_hz, mode.damping, order, DurationRule::table_3_1);
  out.duration_corrected_s = recommended_duration_s(mode.f0_hz, mode.damping, order, DurationRule::corrected);
  out.spacing_hz = required_line_spacing_hz(out.b_3db_hz, n_e, order, relative_bias);
  out.intergrid_damping = intergrid_damping_3db(out.spacing_hz, mode.f0_hz);
  return out;
}

PeakBias peak_bias(const LpmGrid& grid, int k, const Mode& mode) {
  const double half_width = mode.damping * mode.f0_hz;  // B_3dB / 2
  const auto offsets = grid.offsets_hz(k);
  const auto row = grid.own_constant_row(k);
  std::complex<double> fit = 0.0;
  for (std::size_t i = 0; i < offsets.size(); ++i)
    fit += row[i] / std::complex<double>(1.0, offsets[i] / half_width);
  const double b_lpm = (offsets.back() - offsets.front()) * grid.window() / (grid.window() - 1);
  const double power = std::pow(0.5 * b_lpm / half_width, grid.bias_exponent());
  PeakBias out;
  out.exact = std::abs(fit - 1.0);
  out.constant = bias_constant(grid, k, BiasConstant::exact_offsets);
  out.discrete = out.constant * power;
  out.limit = limit_bias_constant(grid.options().order) * power;
  if (const auto printed = printed_bias_constant(grid.options().order)) out.printed = *printed * power;
  double gap = 0.0;
  if (k > 0) gap = grid.frequency_hz(k) - grid.frequency_hz(k - 1);
  if (k + 1 < grid.line_count()) gap = std::max(gap, grid.frequency_hz(k + 1) - grid.frequency_hz(k));
  out.intergrid = intergrid_error(gap, mode.f0_hz, mode.damping);
  return out;
}

std::optional<int> nearest_line(const LpmGrid& grid, double f0_hz) {
  const int last = grid.line_count() - 1;
  const double below = 2.0 * grid.frequency_hz(0) - grid.frequency_hz(1);
  const double above = 2.0 * grid.frequency_hz(last) - grid.frequency_hz(last - 1);
  if (f0_hz < below || f0_hz > above) return std::nullopt;
  int best = 0;
  for (int k = 1; k <= last; ++k) {
    if (std::abs(grid.frequency_hz(k) - f0_hz) < std::abs(grid.frequency_hz(best) - f0_hz)) best = k;
  }
  return best;
}

Result<LpmGrid> uniform_window(double spacing_hz, int n_e, int order) {
  FATMC_CHECK(spacing_hz > 0.0 && n_e >= 1, "a spacing and a window");
  PeriodicExperiment experiment;
  const int count = 2 * n_e + 1;
  for (int k = 1; k <= count; ++k) experiment.lines.push_back(k);
  experiment.period_samples = 4 * count;
  experiment.periods = 2;
  experiment.rate_hz = spacing_hz * experiment.period_samples;
  return LpmGrid::create(std::move(experiment), {n_e, order, std::min(n_e, order + 2)}, 1);
}

}  // namespace fatmc
