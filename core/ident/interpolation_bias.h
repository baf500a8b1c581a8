// Interpolation bias of the local polynomial method, estimated from the estimate (T 2.142-2.145, C.2, C.3).
//
// Near a lightly damped pole an element behaves as G(d) = G0 / (1 + j x), x = 2 d / B_3dB, d the distance from the
// peak. Its expansion sum (-j x)^n is reproduced by a polynomial of even degree R up to n = R. The term n = R + 1 is odd
// and drops out of the constant term of a symmetric fit; the next, |x|^(R+2), leaves
//
//   b = |sum_i s_i (2 d_i / B_3dB)^(R+2)| |G|
//
// with s the row of the least-squares fit of degree R that gives its constant term. For many lines evenly over [-B_lpm/2, B_lpm/2]
// the sum tends to alpha (B_lpm / B_3dB)^(R+2): writing y^n for n = R + 2 as P_n(y)/lead_n plus lower terms that the fit
// reproduces, the fit's value at 0 is -P_n(0)/lead_n, and
//
//   alpha = |P_n(0)| / lead_n = binomial(n, n/2) / binomial(2n, n)   (3/35, 5/231, 7/1287 = 35/6435 for R = 2, 4, 6).
//
// Table 2-3 prints 0.0857, 8.65e-6, 4.86e-9: the second is (5/231) 0.02^2 (the exponent was left at 4), the third is
// unexplained. Odd R: the fit's error starts with the even power R + 1, which takes the place of R + 2.
//
// B_3dB comes from a polynomial of degree max(R, 2) through the estimated element over the same window, its linear term
// dropped: B_3dB = 2 sqrt((1 - 1/sqrt 2) |g0 / g2|) (C.14). That polynomial is complex, g0 (1 - jx - x^2) at a peak,
// and C.9 asks where its even part, not its magnitude, drops to 1/sqrt 2: at x^2 = 1 - 1/sqrt 2 instead of 1. So the
// estimate exceeds the error at a narrow peak by (1 - 1/sqrt 2)^-2 = 11.7 for R = 2: conservative, as 5.3.3 observes.
#pragma once

#include <numbers>
#include <optional>

#include "core/ident/frm_estimate.h"
#include "core/ident/lpm_grid.h"
#include "core/ident/matrix_stack.h"

namespace fatmc {

enum class BiasConstant {
  exact_offsets,  ///< the sum above over the lines of the window: the default. In windows that are shifted (borders) or uneven
                  ///< the odd power R + 1 does not drop out and leads; the formula leaves it out, as (2.145) does
  limit,          ///< alpha of many lines, with B_lpm = (2 n_E + 1) times the mean spacing in the window
  printed,        ///< Table 2-3's alpha with the same B_lpm; R = 2, 4, 6 only
};

/// alpha of the limit for degree `order`.
double limit_bias_constant(int order);
/// alpha as Table 2-3 prints it; none for other orders.
std::optional<double> printed_bias_constant(int order);

/// Either of the two; not for exact_offsets, which has a value a line.
double named_bias_constant(BiasConstant constant, int order);
/// 1 - 1/sqrt 2: the drop that T calls 3 dB.
inline constexpr double kThreeDbDrop = 1.0 - 1.0 / std::numbers::sqrt2;

/// b of every element, n_out x n_in a line, in the unit of G; never negative. Where g0 and g2 both vanish, zero; where
/// g0 alone does, the 3-dB range is zero and so is |G| in the mean: zero as well.
/// `grid` is the one behind the estimate. BiasConstant::printed needs order 2, 4 or 6.
MatrixStack<double> interpolation_bias(const LpmGrid& grid, const FrmEstimate& estimate,
                                       BiasConstant constant = BiasConstant::exact_offsets);

/// alpha with which every line's b = alpha (B_lpm / B_3dB)^E |G| is written, B_lpm = (2 n_E + 1) times the mean spacing of
/// the window: of the actual offsets at line k, or the limit's or Table 2-3's, the same at all lines.
double bias_constant(const LpmGrid& grid, int k, BiasConstant constant);

/// How (2.142), k Psi_0 = Psi_2 B^2 + Psi_1 B + Psi_0 with k = 1/sqrt 2, is solved for the 3-dB range |B_1 - B_2|.
enum class ThreeDbRule {
  linear_dropped,  ///< 2 sqrt((1 - k) |Psi_0/Psi_2|): what T uses, and what the bias is made of
  linear_kept,     ///< |sqrt(Psi_1^2 - 4 (1 - k) Psi_0 Psi_2) / Psi_2| (2.143, 2.144)
};
// At a narrow peak G0/(1 + jx) the true width is 2 in x; the first rule gives 2 sqrt(1 - k) = 1.08, the second
// 2 sqrt(1 - k - 1/4) = 0.41: there the linear term of the complex polynomial is the turning phase, not a slope of the
// magnitude, and cancels most of the curvature.

/// The 3-dB range estimate of every element in Hz; infinite where the polynomial has no curvature.
MatrixStack<double> three_db_range_hz(const LpmGrid& grid, const FrmEstimate& estimate,
                                      ThreeDbRule rule = ThreeDbRule::linear_dropped);

}  // namespace fatmc
