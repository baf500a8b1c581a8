// Structured singular value of a loop whose plant is known to within a disc an element: upper and lower bound.
//
// Plant G (n_out × n_in) with elements G_ij + w_ij δ_ij, |δ_ij| ≤ 1, radii w_ij ≥ 0, under u = K (r − y); loop matrix
// X = (I + K G)⁻¹ K and M = −W S X T as in loop_matrix.h. The plant set is stable if ssv(M) < 1 (T 2.228).
//
// M has the rank of X, and both bounds collapse to matrices of the size of X:
//
// Upper: inf over diagonal D of σ_max(D M D⁻¹) = σ_max(diag(a) X diag(b)), a_j² = Σ_i w_ij² d_ij², b_i² = Σ_j 1/d_ij².
// For given a, b only w_ij d_ij² matters along rows and columns, and at the best D d_ij² = s_i t_j / w_ij, hence
//   a_j² = t_j Σ_i w_ij s_i,   b_i² = (1/s_i) Σ_j w_ij / t_j,
// convex in log s and log t with n_in + n_out − 2 free variables: Newton with the exact Hessian (scaling_problem.h).
//
// Lower: the largest |eigenvalue| of X diag(p) W diag(q) over unit phases p, q: at the worst case every δ_ij turns
// (zᴴX)_i x_j w_ij to the phase of the eigenvalue, so its phases have rank one (phase_problem.h). Where σ_max is simple at
// the optimum its singular vectors are that worst case and the bounds meet: a certificate. Where it is multiple the
// bounds may differ (nine blocks, more than the three for which D-scaling is exact); the lower one is then climbed from
// several combinations of the active singular vectors.
#pragma once

#include <Eigen/Core>
#include <string_view>

namespace fatmc {

/// Scalings from which the next frequency or epoch may start.
struct SsvScaling {
  Eigen::VectorXd log_s;  ///< n_out; empty: cold start
  Eigen::VectorXd log_t;  ///< n_in
};

enum class SsvStatus {
  met,            ///< upper and lower bound agree to `SsvOptions::agreement`: a certificate for this plant
  gap,            ///< the upper bound is the optimum of D-scaling; the lower bound stayed below it
  not_converged,  ///< both bounds hold, but the upper one may be above the optimum of D-scaling
};
std::string_view ssv_status_name(SsvStatus status);

struct SsvBounds {
  double upper = 0.0;
  double lower = 0.0;
  SsvStatus status = SsvStatus::met;
  int iterations = 0;       ///< evaluations of σ_max
  double excess = 0.0;      ///< residual: the upper bound is above the optimum of D-scaling by at most about this (relative)
  double multiplicity = 1;  ///< effective number of singular values that share the optimum (1: simple)
  int climbs = 0;           ///< starts of the lower bound beyond the singular vectors

  [[nodiscard]] bool certified() const { return status == SsvStatus::met; }
};

/// The perturbation that attains the lower bound: the smallest known multiple of the radii that destabilises the loop.
struct WorstCase {
  Eigen::MatrixXcd delta;  ///< n_out × n_in, |delta_ij| = w_ij / lower and det(I − X delta) = 0; the plant is G − delta
};

struct SsvOptions {
  double agreement = 1e-8;  ///< relative gap below which the bounds count as equal; round-off is about 1e-14
  int max_iterations = 300; ///< evaluations of σ_max; a cold start takes about 6, a multiple σ_max about 40
  int max_climbs = 12;      ///< starts of the lower bound where σ_max is multiple
};

/// Bounds of ssv(M). `x` is n_in × n_out, `radii` n_out × n_in, all finite, radii not negative; zero radii and a
/// singular x are allowed. `scaling`, if given, is read as a start and left at the optimum. `worst`, if given, receives
/// the perturbation behind the lower bound (empty where that is zero). 3 × 3 runs without allocation.
SsvBounds structured_singular_value(const Eigen::Ref<const Eigen::MatrixXcd>& x,
                                    const Eigen::Ref<const Eigen::MatrixXd>& radii, const SsvOptions& options = {},
                                    SsvScaling* scaling = nullptr, WorstCase* worst = nullptr);

}  // namespace fatmc
