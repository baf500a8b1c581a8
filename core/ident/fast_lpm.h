// Fast local polynomial method: frequency response matrix and covariance from one periodic experiment.
//
// Z = [Y; U] are the spectra of outputs and inputs at the excited bins. For every line:
//   transient  Z^ = Z - T^, T^ from a polynomial through neighbouring non-excited bins      (2.99-2.111)
//   noise      C_Z_noise = mu_poly residual residual^H / q_noise                            (2.112-2.115)
//   regression Z_n = Theta L, L = [1; d; d^2 ...] kron R over the window of 2 n_E + 1 lines (2.123-2.131)
//              R: known references (indirect) or U^ (direct, Z = Y)
//   C_Z        = residual residual^H / q,  q = 2 n_E + 1 - (R + 1) n_in                     (2.146, 2.147)
//   A          = conj(S^H S), S = L^H (L L^H)^-1 restricted to the constant-term columns
//   indirect   G = G_yr G_ur^-1, C_V = [I -G] C_Z [I -G]^H, B = G_ur^-T A conj(G_ur^-1)     (2.149, 2.150)
//   direct     C_V = C_Z, B = A
//   result     Cov vec(G) = B kron C_V
//
// Print differs: (2.146) uses C_Z itself as Cov vec(G), which leaves out A, so that coverage would depend on the DFT
// scale; (2.48) and (2.150) print G_ru^-T for G_ur^-T. No Kronecker product is formed.
//
// L^T = Q R1 with the constant terms as its last columns, so that their block R33 alone gives both
// G_Z^T = R33^-1 (Q^H Z^T)_last and A = R33^-1 R33^-H, and the rows of Q^H Z^T below are the residuals in an
// orthonormal basis: the normal equations, which square the condition number, never appear.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "core/ident/frm_estimate.h"
#include "core/ident/lanes.h"
#include "core/ident/lpm_grid.h"

namespace fatmc {

/// Spectra at the excited lines, line_count x channels.
using LineSpectra = Eigen::MatrixXcd;

/// QR of every line's regression on one set of references. Const after construction, may be shared by threads.
class LpmDesign {
 public:
  /// `reference`: line_count x n_in.
  LpmDesign(const LpmGrid& grid, const Eigen::Ref<const LineSpectra>& reference);

 private:
  friend class FastLpm;
  int batches_ = 0;
  std::vector<ComplexLanes> factors_;  ///< a batch: window x parameters, then parameters, then A and R33^-1
};

/// The estimator. Owns its workspace: nothing is allocated after the first estimate, one object a thread.
class FastLpm {
 public:
  FastLpm(LpmGrid grid, int n_out);

  [[nodiscard]] const LpmGrid& grid() const { return grid_; }

  /// DFT, transient removal and noise covariance. `outputs`: total_samples x n_out, `inputs`: total_samples x n_in,
  /// column by column.
  void load(const Eigen::Ref<const Eigen::MatrixXd>& outputs, const Eigen::Ref<const Eigen::MatrixXd>& inputs);
  /// The same from spectra, bin_count x channels (scale of RealDft).
  void load_spectra(const Eigen::Ref<const Eigen::MatrixXcd>& outputs,
                    const Eigen::Ref<const Eigen::MatrixXcd>& inputs);

  /// Estimates from what was loaded; the result stays valid until the next estimate.
  const FrmEstimate& indirect(const Eigen::Ref<const LineSpectra>& reference);
  /// With references whose QR is known already.
  const FrmEstimate& indirect(const LpmDesign& design);
  /// Regression of the outputs on the inputs themselves: for open-loop records with little input noise.
  const FrmEstimate& direct();

 private:
  void lay_out_transient_weights();
  void load_batch(int batch);
  void begin(bool indirect);
  Lanes solve_indirect(const ComplexLanes* a);
  void propagate(const ComplexLanes* g, const ComplexLanes* e, int stride, int rows, bool subtract);
  void finish_batch(int batch, const ComplexLanes* factors);

  LpmGrid grid_;
  int n_out_, n_in_, n_z_;
  Eigen::MatrixXcd spectra_;                    ///< bin_count x n_z
  Eigen::MatrixXcd mean_;                       ///< line_count x n_z, Z^
  std::vector<Lanes> transient_;                ///< a batch: weights of the transient fits
  std::vector<ComplexLanes> window_;            ///< of one channel: the bins of those fits
  std::vector<ComplexLanes> noise_;             ///< a batch: q_noise x n_z residuals of the transient fits
  std::vector<ComplexLanes> factors_;           ///< of one batch, for references that come only once
  std::vector<ComplexLanes> z_, c_z_, g_z_, small_, solved_, v_, c_v_, b_;
  FrmEstimate estimate_;
};

/// DFT of `samples` (total_samples x channels) at the excited lines of `grid`.
LineSpectra spectra_at_lines(const LpmGrid& grid, const Eigen::Ref<const Eigen::MatrixXd>& samples);

}  // namespace fatmc
