// ETFE, transient LPM and robust LPM: estimates line by line, from averages over periods and over experiments.
//
// Every experiment gives the mean spectra Z^ = [Y; U] at a line and the covariance of their noise:
//   ETFE      Z^ = sqrt(P) mean_l Z^[l], covariance of the scatter between periods, q = P - 1          (2.33, 2.44-2.46)
//   tLPM      Z^ = Z - T^ of the whole record, covariance of the transient fit's residuals             (2.111-2.117)
// sqrt(P) brings the mean over periods to the DFT scale of the whole record.
//
// With as many experiments as inputs, G_Z = Z^ R^-1 and the noise is all there is to judge by: C_V = [I -G] C_Z_noise
// [I -G]^H, B = conj((R R^H)^-1) moved to the input by G_ur. For one input that is (2.43) as it should read,
//   |G|^2 (s_U^2/|U|^2 + s_Y^2/|Y|^2 - 2 Re(s_YU^2 / (Y conj U))) with s^2 those of the mean
// (printed are |G/M| and squares of s^2/U), and |G - G0|^2 / variance ~ F(2, 2q). With more experiments than inputs
// (robust method, Pintelon & Schoukens 2012, ch. 7) the equations over experiments are solved by least squares: C_Z from
// their residuals holds noise and nonlinear distortion, q = experiments - n_in. Nothing is interpolated over frequency.
#pragma once

#include <span>

#include "core/base/error.h"
#include "core/ident/measurement.h"

namespace fatmc {

enum class LineAverage {
  periods,    ///< ETFE: steady state is the user's promise
  transient,  ///< transient LPM
};

struct LineAverageOptions {
  LineAverage average = LineAverage::transient;
  int order = 2;  ///< degree of the transient's polynomial
  /// Non-excited bins on each side. Without: P + R bins in all for P >= 5, which leave q = P - 1 degrees of freedom, the
  /// ETFE's; 5 on each side for fewer periods, where P - 1 would be too few to judge by.
  std::optional<int> n_transient;
};

/// `experiments`: at least n_in of them with the same rate, period, lines and channels; or one of several inputs whose
/// lines excite one input each (zippered, direct only): then estimate.frm.holds() says which.
/// The bias of a single-input estimate (2.40-2.42) comes with it; see relative_etfe_bias.
Result<ResponseEstimate> estimate_by_line_averages(std::span<const Measurement> experiments,
                                                   const LineAverageOptions& options);

/// Bias of Y^/U^ over G0 for circular Gaussian noise, exact: -exp(-|U0|^2/s_U^2) (1 - rho r), r = (|U0|/s_U)/(|Y0|/s_Y),
/// rho the correlation of the errors V_U/U0 and V_Y/Y0 (2.42). Print (2.41) leaves out "1 -", though Table 2-1's last
/// column, twice its third, contains it. `input_snr` = |U0|/s_U, both amplitudes over standard deviations.
std::complex<double> relative_etfe_bias(double input_snr, double output_snr, std::complex<double> rho);

}  // namespace fatmc
