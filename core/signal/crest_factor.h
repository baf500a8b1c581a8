// Phases that make a multisine of given amplitudes low: more excitation for the same largest deflection.
//
// Schroeder (1970): phi_k = -2 pi sum_(l<k) (k - l) P_l, P_l the line's share of the power; good for flat
// spectra on consecutive lines, where it gives about 1.7, of no use on lines with gaps.
//
// L_2p (Guillaume, Schoukens, Pintelon, Kollar 1991): minimise |x|_2p for p = 2, 4, 8 ... 128, each from the
// last; the norm tends to max |x|, so that the crest factor follows. Gauss-Newton on the residuals x[n]^p
// with Levenberg's damping. Its normal matrix needs no Jacobian: with W the DFT of x^(2p-2) and a_k = 2 pi k
// n/N + phi_k,
//   sum_n x^(2p-2) sin a_k sin a_l = Re[exp(j(phi_k - phi_l)) conj W(k-l) - exp(j(phi_k + phi_l)) conj
//   W(k+l)] / 2,
// so that a step costs two transforms and one solution in the number of lines. On Table 5-1's 73 lines it
// brings 3.4 to 3.8 of random phases to about 1.82; clipping (van der Ouderaa 1988) stays at 1.95 with 1,000
// transforms.
#pragma once

#include "core/signal/multisine.h"

namespace fatmc {

/// The same lines and amplitudes with Schroeder's phases, the first being zero.
Multisine schroeder_phases(int period_samples, std::vector<int> lines, std::vector<double> amplitudes);

struct CrestOptions {
  int steps = 10;              ///< accepted or refused, at each p: 30 gain less than 0.02
  int largest_exponent = 128;  ///< p: powers of two from 2; 128 is within 0.3 % of max |x|
};

struct LowCrest {
  Multisine signal;
  double start = 0.0;         ///< crest factor that it began with
  double crest_factor = 0.0;  ///< at the samples of one period; never above `start`
  int steps = 0;
};

/// A local minimum near the phases of `start`, the best signal on the way. Deterministic: random phases in,
/// another minimum out, which keeps several inputs uncorrelated (phase_correlation.h tells). Lines of
/// amplitude zero keep their phases.
LowCrest lower_crest_factor(const Multisine& start, const CrestOptions& options = {});

}  // namespace fatmc
