// Local polynomial method for arbitrary excitation (Pintelon & Schoukens 2012, section 7.2; T 2.5.9.2).
//
//   Z(k + r) = sum_s Theta_s r^s R(k + r) + sum_s t_s r^s + noise,  s = 0 ... R
//
// over the 2 n_E + 1 DFT bins about k: response and transient are polynomials of the same degree and estimated together,
// so that the transient counts as one more input that is always 1 (n_in,add = 1 of 2.127):
//   q = 2 n_E + 1 - (R + 1)(n_in + 1).
// R: references (indirect), which may be anything that excites, or inputs (direct).
#pragma once

#include "core/base/error.h"
#include "core/ident/measurement.h"

namespace fatmc {

struct ArbitraryLpmOptions {
  int n_e = 9;    ///< DFT bins on each side; q = 7 for three inputs and order 2
  int order = 2;  ///< R of response and transient
};

/// Every bin of the band (aperiodic_windows.h) is a line. There is no noise covariance of its own: q_noise = 0, C_Z_noise
/// and C_V_noise are zero, input_snr is infinite and nothing is called an outlier.
Result<ResponseEstimate> arbitrary_lpm(const Measurement& measurement, const ArbitraryLpmOptions& options);

}  // namespace fatmc
