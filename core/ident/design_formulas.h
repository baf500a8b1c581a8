// Formulas for the design of an experiment: duration, line spacing, and what hides between the lines.
//
// A lightly damped mode is described by f0 in Hz and its damping; B_3dB = 2 damping f0 in Hz, the width of its peak.
#pragma once

namespace fatmc {

/// alpha of the magnitude: the limit of many lines for a polynomial fitted to |G| = (1 + x^2)^(-1/2) near a mode. Its
/// coefficient of x^n, n = R + 2, is binomial(n, n/2) / 2^n (3/8, 5/16, 35/128), so that
/// alpha = limit_bias_constant(R) binomial(n, n/2) / 2^n. Table 2-4 prints about 1 % less, and it does not bound the
/// LPM, which fits the complex response. `order` even.
double magnitude_bias_constant(int order);

/// Widest spacing of excited lines in Hz for an interpolation bias of at most `relative_bias` |G|:
/// B_3dB / (2 n_E + 1) (relative_bias / alpha)^(1/(R+2)), alpha = limit_bias_constant(R). The exponent of (2.138) is printed
/// as -(R+2).
double required_line_spacing_hz(double b_3db_hz, int n_e, int order, double relative_bias);

/// n_E of (2.127): ceil(((n_out + m) + (R + 1)(n_in + n_in_add) - 1)/2). n_in_add: 1 where the transient is fitted along.
int lines_each_side(int n_out, int m, int order, int n_in, int n_in_add);

enum class DurationRule {
  table_3_1,  ///< 3 pi / (2 damping f0): reproduces Table 3-1 (f0 in Hz where 2.140 wants rad/s, and 3 for 2R+3 = 7)
  corrected,  ///< (2R+3) / (2 damping f0): (2.140) with B_3dB in Hz, that is twice the printed (2R+3) pi/(2 damping w0)
};

/// Length of a period in s that resolves the mode, n_E = R + 1, relative bias alpha. Line spacing is its inverse.
double recommended_duration_s(double f0_hz, double damping, int order, DurationRule rule);

/// Damping at which a peak midway between two lines exceeds both by 3 dB: df / (2 f0). (2.262) prints df / (4 pi f0), a
/// factor 2 pi too small: lightly damped peaks that it calls covered are not.
double intergrid_damping_3db(double spacing_hz, double f0_hz);

/// Part of a peak's magnitude that lines `spacing_hz` apart can miss: 1 - (1 + x^2)^(-1/2), x = df / (2 damping f0).
double intergrid_error(double spacing_hz, double f0_hz, double damping);

/// Contour of Fig. 2-35: largest df / f0 for which no peak of at least this damping is missed by more than `error`,
/// 0 < error < 1: 2 damping sqrt((1 - error)^-2 - 1).
double intergrid_relative_spacing(double error, double damping);

/// The other way round: least damping that an allowance of `error` covers.
double intergrid_covered_damping(double error, double spacing_hz, double f0_hz);

}  // namespace fatmc
