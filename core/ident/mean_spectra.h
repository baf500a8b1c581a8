// Mean spectra of one periodic experiment and the covariance of their noise, by either of two ways.
#pragma once

#include <Eigen/Core>

#include "core/ident/measurement.h"
#include "core/ident/transient_windows.h"

namespace fatmc {

/// At the excited lines, at the DFT scale of the whole record; channels [Y; U].
struct MeanSpectra {
  Eigen::MatrixXcd mean;                    ///< line_count x n_z
  MatrixStack<std::complex<double>> noise;  ///< n_z x n_z, covariance of `mean`
  Eigen::MatrixXcd reference;               ///< line_count x n_in; empty for a direct estimate
  int q = 0;                                ///< complex degrees of freedom of `noise`
};

/// sqrt(P) times the mean over periods; `noise` from the scatter between periods, q = P - 1 (T 2.33, 2.44-2.46).
MeanSpectra average_periods(const Measurement& m);

/// Spectrum of the whole record without its transient; `noise` from the transient fit (T 2.111-2.115). `windows` are
/// those of the measurement's lines.
MeanSpectra remove_transient(const Measurement& m, const TransientWindows& windows);

/// Bins 0 ... bin_count-1 of every column, bin_count x columns.
Eigen::MatrixXcd record_spectrum(const Eigen::Ref<const Eigen::MatrixXd>& samples, int bin_count);

}  // namespace fatmc
