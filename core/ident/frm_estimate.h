// What a frequency response estimate is: the matrix, its covariance, and how far to trust each line.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <cstdint>
#include <vector>

#include "core/ident/matrix_stack.h"

namespace fatmc {

enum class LineStatus : std::uint8_t {
  ok,
  singular_regressor,  ///< the references (direct: inputs) do not excite all directions inside the window
  singular_input,      ///< G_ur has no inverse: some input does not follow the references
};

/// Line k = 0 ... line_count-1 of the excited lines. A line whose status is not ok holds zeros.
///
/// Covariance of the matrix: Cov vec(G) = B kron C_V, that is Cov(G_ij, G_lm) = B_jm C_V,il; vec stacks columns.
/// B carries the inverse of the DFT scale squared, C_V and C_Z the scale squared; their product is free of it.
struct FrmEstimate {
  int n_out = 0, n_in = 0;
  bool indirect = false;
  int q = 0;        ///< complex degrees of freedom of C_Z and C_V
  int q_noise = 0;  ///< of C_Z_noise and C_V_noise
  std::vector<int> lines;  ///< harmonics of one period; DFT bins of the record or segment where there is no period
  std::vector<double> frequency_hz;

  MatrixStack<std::complex<double>> G;          ///< n_out x n_in
  MatrixStack<std::complex<double>> B;          ///< n_in x n_in
  MatrixStack<std::complex<double>> C_V;        ///< n_out x n_out, total: noise and nonlinear distortion
  MatrixStack<std::complex<double>> C_Z;        ///< of [Y; U] (indirect) or Y (direct), total (2.146)
  MatrixStack<std::complex<double>> C_Z_noise;  ///< of the sample mean of [Y; U], noise alone (2.112, 2.114)
  MatrixStack<std::complex<double>> C_V_noise;  ///< n_out x n_out: [I -G] C_Z_noise [I -G]^H

  MatrixStack<std::complex<double>> U_mean;  ///< n_in x 1, sample mean of the input spectra (2.111)
  MatrixStack<double> input_snr;             ///< n_in x 1, (|U^| - s)/s, s^2 from C_Z_noise (5.10); infinite if s = 0
  MatrixStack<std::uint8_t> outlier;         ///< n_in x 1: |U^| < 3 s (5.2.2)
  std::vector<LineStatus> status;
  std::vector<std::uint8_t> border;  ///< window shifted at an end of the lines
  std::vector<double> regressor_condition;  ///< largest over smallest |R_jj| of the QR: a lower bound
  std::vector<double> input_condition;      ///< |G_ur|_F |G_ur^-1|_F (indirect); 1 for a direct estimate

  /// Empty, or the total variance of every element (n_out x n_in) where it does not factor into B and C_V, as for a
  /// rational fit whose denominator differs from channel to channel. B and C_V are zero then.
  MatrixStack<double> element_variance;
  /// Empty (all inputs at all lines), or n_in x 1: 1 where the line holds an estimate for the input (zippered lines).
  MatrixStack<std::uint8_t> estimated;

  [[nodiscard]] int line_count() const { return static_cast<int>(lines.size()); }
  [[nodiscard]] bool holds(int k, int j) const { return estimated.count() == 0 || estimated[k](j, 0) != 0; }
  /// Total variance of an element, E|G_ij - G0_ij|^2 = B_jj C_V,ii.
  [[nodiscard]] double variance(int k, int i, int j) const {
    if (element_variance.count() > 0) return element_variance[k](i, j);
    return B[k](j, j).real() * C_V[k](i, i).real();
  }
  /// The same from the noise alone.
  [[nodiscard]] double noise_variance(int k, int i, int j) const {
    return B[k](j, j).real() * C_V_noise[k](i, i).real();
  }
};

/// Speed correction (3.4), G := G |V_trim| / |V_mean| with factor = |V_trim| / |V_mean|; covariances follow.
void scale_response(FrmEstimate& estimate, double factor);

}  // namespace fatmc
