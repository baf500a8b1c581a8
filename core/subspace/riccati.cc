#include "core/subspace/riccati.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <string>

#include "core/base/text.h"
#include "core/subspace/eigenvalues.h"

namespace fatmc {
namespace {

constexpr int kMostIterations = 60;
constexpr double kConverged = 1e-14, kWorstResidual = 1e-8;

struct Doubling {
  Eigen::MatrixXd a, g, h;
};

/// One doubling; true where it changed nothing any more. `scale`: of the noise, against which P may vanish.
bool converged_step(Doubling& state, double scale) {
  const Eigen::Index n = state.a.rows();
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(Eigen::MatrixXd::Identity(n, n) + state.g * state.h);
  const Eigen::MatrixXd wa = lu.solve(state.a);  // (I + G H)^-1 A
  const Eigen::MatrixXd wg = lu.solve(state.g);  // (I + G H)^-1 G, symmetric
  const Eigen::MatrixXd added = state.a.transpose() * state.h * wa;
  state.g += state.a * wg * state.a.transpose();
  state.h += added;
  state.a = state.a * wa;
  state.g = 0.5 * (state.g + state.g.transpose()).eval();
  state.h = 0.5 * (state.h + state.h.transpose()).eval();
  return added.norm() <= kConverged * (state.h.norm() + scale);
}

double equation_residual(const Eigen::Ref<const Eigen::MatrixXd>& a,
                         const Eigen::Ref<const Eigen::MatrixXd>& c, const NoiseCovariance& noise,
                         const KalmanGain& gain) {
  const Eigen::MatrixXd innovation = c * gain.p * c.transpose() + noise.r;
  const Eigen::MatrixXd next =
      a * gain.p * a.transpose() + noise.q - gain.k * innovation * gain.k.transpose();
  const double scale = gain.p.norm() + noise.q.norm();
  return scale > 0.0 ? (next - gain.p).norm() / scale : 0.0;
}

}  // namespace

Result<KalmanGain> kalman_gain(const Eigen::Ref<const Eigen::MatrixXd>& a,
                               const Eigen::Ref<const Eigen::MatrixXd>& c, const NoiseCovariance& noise) {
  const Eigen::LLT<Eigen::MatrixXd> r(noise.r);
  if (r.info() != Eigen::Success) {
    return fail(
        "the covariance of the outputs' residuals is not positive definite: an output is a combination of "
        "the others");
  }
  const Eigen::MatrixXd s_r = r.solve(noise.s.transpose()).transpose();  // S R^-1
  Doubling state;
  state.a = (a - s_r * c).transpose();
  state.g = c.transpose() * r.solve(Eigen::MatrixXd(c));
  state.h = noise.q - s_r * noise.s.transpose();
  state.h = 0.5 * (state.h + state.h.transpose()).eval();
  KalmanGain out;
  bool done = false;
  while (!done && out.iterations < kMostIterations) {
    done = converged_step(state, noise.q.norm());
    ++out.iterations;
    if (!state.h.allFinite() || !state.a.allFinite()) break;
  }
  if (!done) return fail("the Riccati equation has no stabilising solution (doubling did not converge)");
  out.p = state.h;
  const Eigen::MatrixXd innovation = c * out.p * c.transpose() + noise.r;
  const Eigen::MatrixXd cross = a * out.p * c.transpose() + noise.s;
  out.k = innovation.ldlt().solve(cross.transpose()).transpose();
  out.residual = equation_residual(a, c, noise, out);
  if (!(out.residual <= kWorstResidual)) {
    return fail("the Riccati equation has no stabilising solution to the digits at hand (relative residual " +
                significant(out.residual, 2) + ")");
  }
  const auto radius = spectral_radius(a - out.k * c);
  if (!radius || !(*radius < 1.0))
    return fail("the Riccati equation has no stabilising solution (A - K C is not stable)");
  out.predictor_radius = *radius;
  return out;
}

}  // namespace fatmc
