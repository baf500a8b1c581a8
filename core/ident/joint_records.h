// Several records of arbitrary excitation, sweeps for instance, solved together.
//
//   Z_e(k) = G_Z R_e(k) + noise,  e = 1 ... E records, E > n_in
//
// Each bin by itself: G_Z by least squares over the records; its residuals leave E - n_in degrees of freedom
// a bin. They are free of any smoothness assumption, and pooled over the 2 n_E + 1 bins of a window they give
// the noise covariance,
//   q = (2 n_E + 1)(E - n_in).
// Smoothed: one polynomial of degree R in the frequency for the window of all records (the regression of fast
// LPM with E values a bin), which lowers the variance and costs a bias where the response is narrower than
// the window.
//
// A bin takes the smoothed value unless its misfit shows against the noise: with SS the sums of squared
// residuals,
//   F_i = (SS_smooth,ii - SS_bin,ii)/(n_in (2 n_E - R)) / (SS_bin,ii / q)  ~  F(2 n_in (2 n_E - R), 2q)
// where the polynomial holds (extra sum of squares, Seber & Lee 2003, section 4.3, complex: twice the degrees
// of freedom); beyond the 99 % quantile in any channel the bin is taken by itself. It is (2.153), total
// against noise covariance, used as a guard. Either way the noise is that of the residuals a bin, independent
// of both estimates:
//   Cov vec(G) = B kron C_V with q, and |G - G0|^2/variance ~ F(2, 2q) but for the bias that the guard lets
//   pass.
//
// No transient is estimated: a record starts and ends at rest, or is long against the response's memory. Over
// a few bins the spectrum of a sweep is as smooth as a transient, and the two cannot be told apart.
#pragma once

#include <span>

#include "core/base/error.h"
#include "core/ident/measurement.h"

namespace fatmc {

struct JointRecordsOptions {
  int n_e = 9;    ///< bins on each side of a window
  int order = 2;  ///< R
};

/// Quantile of the guard. A false alarm costs the smoothing of one bin, a miss a bias below what shows in the
/// noise.
inline constexpr double kMisfitLevel = 0.99;

/// More records than inputs, of one length and rate. Every bin of the band (aperiodic_windows.h) is a line;
/// `fallback` has those that are taken by themselves. C_Z_noise is that of one record's spectrum.
Result<ResponseEstimate> joint_records(std::span<const Measurement> measurements,
                                       const JointRecordsOptions& options);

}  // namespace fatmc
