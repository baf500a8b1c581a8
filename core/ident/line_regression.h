// One line's least-squares problem, Z = Theta L + noise, and what every estimator makes of it.
//
//   G_Z   = Z S,  S = L^H (L L^H)^-1 restricted to the constant-term rows of L
//   A     = conj(S^H S),  Cov vec(G_Z) = A kron C_Z                                (T 2.146 corrected by A)
//   indirect  G = G_yr G_ur^-1,  C_V = [I -G] C_Z [I -G]^H,  B = G_ur^-T A conj(G_ur^-1)     (2.149, 2.150)
//   direct    C_V = C_Z of the outputs alone, B = A
//   Cov vec(G) = B kron C_V
//
// The fast LPM does the same four lines at a time (fast_lpm.h); this is the general form for estimators whose problems
// differ from line to line.
#pragma once

#include <Eigen/Core>

#include "core/ident/frm_estimate.h"

namespace fatmc {

struct LineRegression {
  Eigen::MatrixXcd G_Z;  ///< channels x n_in
  Eigen::MatrixXcd C_Z;  ///< channels x channels; empty where no degree of freedom is left
  Eigen::MatrixXcd A;    ///< n_in x n_in
  double condition = 1.0;  ///< largest over smallest |R_jj| of the QR, columns scaled to length 1; infinite: singular
};

/// `regressor`: L^T, rows x parameters, rows >= parameters, the constant terms being its last n_in columns;
/// `channels`: Z^T, rows x channels.
LineRegression regress_line(const Eigen::Ref<const Eigen::MatrixXcd>& regressor,
                            const Eigen::Ref<const Eigen::MatrixXcd>& channels, int n_in);

/// Beyond this condition a direction of the regressor or of G_ur is round-off.
inline constexpr double kSingularCondition = 1e13;

/// Sizes every stack of an estimate for its n_out, n_in, lines and indirect; all lines ok, none at a border.
void size_estimate(FrmEstimate& estimate);

/// Makes line k of `estimate` from a regression of [Y; U] on references (estimate.indirect) or of Y on U. C_Z_noise[k]
/// (of [Y; U]) must stand: C_V_noise follows from it. Where `regression.C_Z` is empty, C_V and C_Z take the noise
/// alone: then C_V = [I -G] C_Z_noise [I -G]^H for a direct estimate too, which carries the noise of the inputs (2.43).
/// A singular line gets zeros and its status.
void store_line(FrmEstimate& estimate, int k, const LineRegression& regression);

/// U_mean, input_snr (5.10) and outlier (5.2.2) of line k from the input spectra and C_Z_noise[k].
void store_input_quality(FrmEstimate& estimate, int k, const Eigen::Ref<const Eigen::VectorXcd>& inputs);

}  // namespace fatmc
