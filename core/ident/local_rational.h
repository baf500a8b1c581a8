// Local rational method (McKelvey & Guerin 2012; T 2.5.9.3): response and denominator by one linear problem a line.
//
//   channel c:  Z_c(k + r) A_c(r) = sum_s b_cs r^s R(k + r) [+ sum_s t_cs r^s] + A_c(r) noise,   A_c(r) = 1 + a_c1 r + ...
//
// Multiplied out it is linear in a, b, t; A_c(0) = 1, so that b_c0 is the response at the line itself. Each channel of
// [Y; U] (indirect) or Y (direct) has a denominator of its own.
//   periodic record (2 periods or more): Z^ without its transient at 2 n_E + 1 excited lines, no t
//   other records: 2 n_E + 1 DFT bins, the transient has the same denominator as the response
//   q = 2 n_E + 1 - (R + 1) n_in - R [- (R + 1)]
//
// Covariance, to first order in the noise V_c of the channels, which the problem sees as A_c V_c: with P_c the rows of
// channel c's pseudoinverse that give b_c0 and M_c = I - L_c L_c^+,
//   C_Z,cd = residual_c residual_d^H / tr(M_c diag(A_c) diag(A_d)^H M_d^H)
//   Cov(b_c0j, b_dl0) = C_Z,cd sum_w P_c(j, w) A_c(w) conj(P_d(l, w) A_d(w)).
// (Residuals over q alone would call the noise the same all over the window: near a mode A_c grows away from the line.)
// Channels differ in P_c, so Cov vec(G) is no Kronecker product: FrmEstimate::element_variance holds the variances, moved
// through G_ur for indirect estimates. There is no exact law for the error: the noise stands in the regressor too.
//
// Guard: a root of A_c closer to a bin of the window than a quarter of the bins' spacing makes the fit meaningless
// between bins; such a line falls back to the local polynomial of the same window and is listed in `fallback`. So does
// one whose A_c has coefficients that are not finite, and one whose b_0 the window leaves open: the smallest solution
// would share the response among inputs that cannot be told apart, where polynomials give singular_regressor.
#pragma once

#include "core/base/error.h"
#include "core/ident/measurement.h"

namespace fatmc {

struct LocalRationalOptions {
  int n_e = 6;          ///< lines or bins on each side
  int order = 2;        ///< R of numerator, denominator and transient
  int n_transient = 5;  ///< non-excited bins on each side (periodic records)
  double guard = 0.25;  ///< least distance of a pole from a bin, in mean spacings of the window
  int threads = 1;      ///< the result does not depend on it
};

Result<ResponseEstimate> local_rational(const Measurement& measurement, const LocalRationalOptions& options);

}  // namespace fatmc
