// Total against noise covariance: what of the scatter is not noise (T 2.5.7, 2.153).
//
// The fast LPM estimates one covariance twice. C_Z from the residuals over excited lines holds noise,
// stochastic nonlinear distortion and whatever the polynomials do not follow; C_Z_noise from the non-excited
// bins of the same band holds noise and the distortion that falls there (none, where the nonlinearity makes
// harmonics of the period alone). For a channel i
//
//   C_S,ii = max(0, C_Z,ii - C_Z_noise,ii)   (2.153; its 1/P belongs to another scale of the DFT)
//   ratio  = C_Z,ii / C_Z_noise,ii ~ F(2q, 2 q_noise) where nothing but noise is there.
//
// The same for v = y - G u, the noise at the plant's output, with C_V and C_V_noise: there a nonlinear
// controller or actuator ahead of the measured input does not count.
//
// The law takes both estimates for independent, although neighbouring lines share the transients that are
// taken off. In white noise the test keeps its level all the same: of 1,000 simulated records it rejects 5.02
// % of outputs and lines at 5 % on Table 5-1's lines with three inputs (standard error 0.10 %), 4.88 % (0.27
// %) on 40 consecutive lines with one (unit_ident, NonlinearDistortion.ItsTestRejectsNoiseAsOftenAsItSays).
// Noise that is coloured within the window and an interpolation bias that is large beside the noise raise C_Z
// as a nonlinearity does.
#pragma once

#include <vector>

#include "core/ident/frm_estimate.h"

namespace fatmc {

struct NonlinearDistortion {
  MatrixStack<double> output_ratio;   ///< n_out x 1 a line: C_V,ii / C_V_noise,ii; 1 where both are zero
  MatrixStack<double> channel_ratio;  ///< n_out + n_in x 1: C_Z,ii / C_Z_noise,ii; empty (0 x 1) for a direct
                                      ///< estimate, whose residuals are those of y - G u
  double level = 0.0;                 ///< of the test, for one line and channel
  double limit = 0.0;                 ///< F^-1(1 - level; 2q, 2 q_noise)
  std::vector<int> above;             ///< an output: lines whose output_ratio exceeds the limit

  [[nodiscard]] double median_output_ratio(int i) const;
};

/// Needs q_noise > 0 (a method with a noise estimate of its own) and 0 < level < 1. Lines without an estimate
/// count as 1.
NonlinearDistortion nonlinear_distortion(const FrmEstimate& estimate, double level = 0.01);

/// C_S (2.153) of channel i of [Y; U] (direct: of y - G u), line k, at the scale of C_Z; never negative.
double distortion_variance(const FrmEstimate& estimate, int k, int i);

}  // namespace fatmc
