// What an experiment must be to show a mode: width, duration, and what the local polynomial makes of its
// peak.
#pragma once

#include <optional>

#include "core/ident/lpm_grid.h"

namespace fatmc {

struct Mode {
  double f0_hz = 0.0;    ///< > 0
  double damping = 0.0;  ///< > 0
};

/// Independent of any experiment (design_formulas.h has the equations).
struct ModeRequirement {
  double b_3db_hz = 0.0;              ///< 2 damping f0
  double duration_table_s = 0.0;      ///< DurationRule::table_3_1
  double duration_corrected_s = 0.0;  ///< DurationRule::corrected
  double spacing_hz = 0.0;            ///< widest spacing of lines for the tolerated bias
  double intergrid_damping = 0.0;     ///< damping from which on `spacing_hz` shows a peak at f0 within 3 dB
};
ModeRequirement mode_requirement(const Mode& mode, int n_e, int order, double relative_bias);

/// Relative bias at a peak G = 1/(1 + j 2 d/B_3dB), d the distance from it, that stands on line k of `grid`.
struct PeakBias {
  /// |sum s_i G(d_i) - 1|, s the constant row of degree R: what the fit does, without noise.
  double exact = 0.0;
  double discrete = 0.0;          ///< leading term with the constant of the actual offsets
  double limit = 0.0;             ///< with the constant of many lines
  std::optional<double> printed;  ///< with Table 2-3's constant; none for orders it leaves out
  double constant = 0.0;          ///< alpha of the actual offsets
  double intergrid = 0.0;         ///< share of the peak that the wider gap beside line k can miss
};
PeakBias peak_bias(const LpmGrid& grid, int k, const Mode& mode);

/// The line nearest to f0; none where f0 lies outside the band by more than the spacing there.
std::optional<int> nearest_line(const LpmGrid& grid, double f0_hz);

/// Lines `spacing_hz` apart, as many as one window of 2 n_e + 1 has; line n_e stands in its middle.
Result<LpmGrid> uniform_window(double spacing_hz, int n_e, int order);

}  // namespace fatmc
