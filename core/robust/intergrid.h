// Intergrid error: what a frequency grid can miss between its lines (T section 2.8.4).
//
// Worst case: a lightly damped pair of poles midway between two lines that are Δf apart. Near its peak G ≈ G_0/(1 + j x)
// with x = d/(ζ f_0), d the distance from f_0 (3-dB range 2 ζ f_0), so that at the lines, d = Δf/2, the peak exceeds
// what is measured by
//
//   ε = sqrt(1 + (Δf / (2 ζ f_0))²) − 1         (relative to the measured magnitude; magnitude only, as T takes it)
//
// ε = √2 − 1 (3 dB) at ζ = Δf/(2 f_0). (2.262) divides by ω_0 instead and prints Δf/(4π f_0), 2π too small and not on the
// safe side; Fig. 2-35 follows the right relation: its example Δf/f_0 = 0.005, ε = 5 % gives ζ = 0.0078 (0.008 in print).
//
// Damping ζ ≪ 1 and spacing Δf ≪ f_0 are assumed; the error of the relation is of the order of either.
#pragma once

namespace fatmc {

/// Damping of a resonance that is missed by 3 dB: Δf/(2 f_0) (2.262, corrected). Both > 0.
double three_db_damping(double spacing_hz, double frequency_hz);

/// The same as (2.262) prints it, Δf/(4π f_0); for comparison alone.
double printed_three_db_damping(double spacing_hz, double frequency_hz);

/// ε for a resonance of `damping` > 0; `relative_spacing` = Δf/f_0 ≥ 0.
double intergrid_error(double relative_spacing, double damping);

/// Contour of Fig. 2-35: the widest Δf/f_0 at which no resonance of at least `damping` ≥ 0 is missed by more than
/// `error` ≥ 0: 2 ζ sqrt((1 + ε)² − 1).
double largest_relative_spacing(double damping, double error);

/// Inverse of it in ζ: damping down to which an allowance of `error` covers a grid; infinite for error 0.
double covered_damping(double relative_spacing, double error);

}  // namespace fatmc
