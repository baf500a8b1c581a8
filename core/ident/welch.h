// Spectral estimate after Welch, conditioned for several inputs (Bendat & Piersol 2010, ch. 7; T 2.2.6.4).
//
//   S_ab = mean over segments of a b^H, segments tapered and overlapping
//   direct    G = S_yu S_uu^-1                     the inputs may be correlated: S_uu^-1 conditions each on the others
//   indirect  G = S_yr S_ur^-1                     no bias from feedback
//   C_Z = (S_zz - S_zr S_rr^-1 S_rz) K/(K - n_in), A = conj(S_rr^-1)/K;  K segments (effective number)
//   multiple coherence of output i: (S_yr S_rr^-1 S_ry)_ii / S_yy,ii
// so that an ordinary estimate is the line regression of fast LPM with segments in the place of lines: q = K - n_in and,
// for independent segments, |G - G0|^2/variance ~ F(2, 2q). Overlapping tapered segments are correlated; K is their
// number over 1 + 2 sum_m (1 - m/K) rho_m^2 with rho_m the correlation of tapers m hops apart (Welch 1967), rounded
// down in q. Leakage and transients of segments are not modelled: short segments bias resonances.
#pragma once

#include "core/base/error.h"
#include "core/ident/measurement.h"

namespace fatmc {

enum class Taper { hann, none };

struct WelchOptions {
  int segment_samples = 0;  ///< 0: a period, or for aperiodic records an eighth of the record, rounded to even
  double overlap = 0.5;     ///< share of a segment in [0, 0.9]; half is what a Hann taper leaves unused
  Taper taper = Taper::hann;
};

/// Lines are bins of one segment, 1 ... (segment-1)/2; between the first and last excited line where those are known.
/// The mean of each segment is taken off. q_noise = 0: there is no noise covariance apart.
Result<ResponseEstimate> welch(const Measurement& measurement, const WelchOptions& options);

/// Number of independent segments that `segments` with this hop and taper are worth.
double effective_segments(int segments, int segment_samples, int hop, Taper taper);

}  // namespace fatmc
