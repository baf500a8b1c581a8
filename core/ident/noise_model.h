// Nonparametric noise model: spectra of a record with fixed controls, averaged over segments (T A.7, A.8).
//
// All that moves is noise. The record is cut into M segments; V^[l](k) are their spectra and
//
//   C(k) = 1/(M-1) sum_l (V^[l] - mean)(V^[l] - mean)^H                                          (2.44-2.46)
//
// is the covariance of one segment's spectrum, q = M - 1 complex degrees of freedom. A further observation V
// of the same noise satisfies |V_i|^2 / C_ii ~ F(2, 2q), all channels together V^H C^-1 V ~ n q/(q - n + 1)
// F(2n, 2(q - n + 1)), the joint law of confidence_regions.h for one input. Hence the radii
//
//   one channel             sqrt(C_ii) sqrt F^-1(p; 2, 2(M-1))                              (A.11, A.12)
//   all n at once (shadow)  sqrt(C_ii) sqrt(n (M-1)/(M-n) F^-1(p; 2n, 2(M-n)))               (A.14, A.15)
//
// Print has F(1, M-1) and n/(M-n) F(n, M-n): the laws of real variables (a complex one has two parts), and
// the factor M - 1 is left out of the second. With M = 20 the printed 95 % of one channel would hold 97.9 %.
//
// Segments are not tapered, as in T: leakage of a record that drifts shows at the lowest bins.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "core/base/error.h"
#include "core/ident/matrix_stack.h"

namespace fatmc {

struct NoiseModel {
  int channels = 0;
  int segments = 0;  ///< M
  int segment_samples = 0;
  double rate_hz = 0.0;
  std::vector<double> frequency_hz;  ///< bins 1 ... (segment_samples - 1)/2
  MatrixStack<std::complex<double>>
      covariance;  ///< channels x channels, of a spectrum of one segment (scale N^-1/2)

  [[nodiscard]] int q() const { return segments - 1; }
  /// Two-sided power spectral density of channel i per Hz.
  [[nodiscard]] double density(int k, int i) const { return covariance[k](i, i).real() / rate_hz; }
};

/// `samples`: one column a channel; what remains after the last whole segment is left out. Fails where there
/// are fewer than two segments.
Result<NoiseModel> noise_model(const Eigen::Ref<const Eigen::MatrixXd>& samples, double rate_hz,
                               int segment_samples);

/// Segments for a relative standard error `variation` of the variances: 1 + variation^-2, rounded up, since a
/// variance of q complex degrees of freedom has the coefficient of variation q^-1/2. (A.6) prints
/// 2/variation^2, the figure for the q real degrees of freedom of a real variable: twice the segments that
/// are needed. The record lasts M/df (A.8).
int required_segments(double variation);

}  // namespace fatmc
