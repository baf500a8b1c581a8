#include "core/subspace/predictor_regression.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <limits>

namespace fatmc {
namespace {

/// The problem in the singular directions of R.
struct SpectralProblem {
  RidgeSpectrum spectrum;
  Eigen::MatrixXd v;     ///< right singular vectors
  Eigen::MatrixXd beta;  ///< left singular vectors^T b
};

SpectralProblem spectral_problem(const PredictorFactor& factor) {
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(factor.r, Eigen::ComputeFullU | Eigen::ComputeFullV);
  SpectralProblem out;
  out.v = svd.matrixV();
  out.beta = svd.matrixU().transpose() * factor.b;
  out.spectrum = {svd.singularValues(), out.beta.rowwise().squaredNorm(), factor.residual.sum(),
                  static_cast<double>(factor.equations)};
  return out;
}

/// Without any singular value: R itself, or [R; lambda I] made triangular again.
Result<PredictorMarkov> solve_fixed(const PredictorFactor& factor, double lambda) {
  const Eigen::Index m = factor.r.rows();
  PredictorMarkov out;
  out.lambda = lambda;
  if (lambda == 0.0) {
    if (Status status = check_pivots(factor.r.diagonal()); !status) return fail(status.error());
    out.xi = factor.r.triangularView<Eigen::Upper>().solve(factor.b).transpose();
    out.freedom = static_cast<double>(m);
    return out;
  }
  Eigen::MatrixXd stacked(2 * m, m);
  stacked.topRows(m) = factor.r;
  stacked.bottomRows(m) = lambda * Eigen::MatrixXd::Identity(m, m);
  Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(stacked);
  Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(2 * m, factor.n_y);
  rhs.topRows(m) = factor.b;
  rhs.applyOnTheLeft(qr.householderQ().adjoint());
  const auto triangle = qr.matrixQR().topRows(m).template triangularView<Eigen::Upper>();
  out.xi = triangle.solve(rhs.topRows(m)).transpose();
  // sum f = ||R Rl^-1||_F^2 with Rl^T Rl = R^T R + lambda^2 I.
  const Eigen::MatrixXd share = triangle.transpose().solve(Eigen::MatrixXd(factor.r.transpose()));
  out.freedom = share.squaredNorm();
  return out;
}

}  // namespace

Status check_pivots(const Eigen::Ref<const Eigen::VectorXd, 0, Eigen::InnerStride<>>& diagonal) {
  const Eigen::ArrayXd pivots = diagonal.array().abs();
  if (pivots.minCoeff() > 1e-13 * pivots.maxCoeff()) return {};
  return fail(
      "the regression on the past is singular: give a regularization (gcv, or a lambda above 0), a shorter "
      "past, or maneuvers that move every input");
}

Status check_past_window(std::span<const Maneuver> maneuvers, int past) {
  if (Status status = check_maneuvers(maneuvers); !status) return status;
  const int largest = largest_past_window(maneuvers);
  Eigen::Index shortest = maneuvers.front().samples();
  for (const Maneuver& maneuver : maneuvers) shortest = std::min(shortest, maneuver.samples());
  if (past < 1) return fail("the past window is " + std::to_string(past) + ", it needs at least 1 sample");
  if (past + 1 >= shortest) {
    return fail("a maneuver of " + std::to_string(shortest) + " samples is too short for a past window of " +
                std::to_string(past) + ": leave it out or shorten the past");
  }
  if (past > largest) {
    return fail("a past window of " + std::to_string(past) +
                " has more unknowns than equations, the largest for these maneuvers is " +
                std::to_string(largest));
  }
  return {};
}

PredictorEquations predictor_equations(std::span<const Maneuver> maneuvers, int past, Eigen::Index first,
                                       Eigen::Index last) {
  const Eigen::Index n_u = maneuvers.front().inputs.cols(), n_y = maneuvers.front().outputs.cols(),
                     n_z = n_u + n_y;
  Eigen::Index count = 0;
  for (const Maneuver& maneuver : maneuvers) count += std::min(last, maneuver.samples()) - first;
  PredictorEquations out{Eigen::MatrixXd(count, past * n_z), Eigen::MatrixXd(count, n_z)};
  Eigen::Index row = 0;
  for (const Maneuver& maneuver : maneuvers) {
    const Eigen::Index rows = std::min(last, maneuver.samples()) - first;
    for (int lag = 1; lag <= past; ++lag) {
      out.phi.block(row, (lag - 1) * n_z, rows, n_u) = maneuver.inputs.middleRows(first - lag, rows);
      out.phi.block(row, (lag - 1) * n_z + n_u, rows, n_y) = maneuver.outputs.middleRows(first - lag, rows);
    }
    out.z.block(row, 0, rows, n_u) = maneuver.inputs.middleRows(first, rows);
    out.z.block(row, n_u, rows, n_y) = maneuver.outputs.middleRows(first, rows);
    row += rows;
  }
  return out;
}

Result<PredictorFactor> factor_predictor(std::span<const Maneuver> maneuvers, int past) {
  if (Status status = check_past_window(maneuvers, past); !status) return fail(status.error());
  PredictorFactor out;
  out.past = past;
  out.n_u = static_cast<int>(maneuvers.front().inputs.cols());
  out.n_y = static_cast<int>(maneuvers.front().outputs.cols());
  Eigen::Index longest = 0;
  for (const Maneuver& maneuver : maneuvers) {
    out.equations += maneuver.samples() - past;
    longest = std::max(longest, maneuver.samples());
  }
  const Eigen::Index m = static_cast<Eigen::Index>(past) * out.n_z();
  const PredictorEquations data = predictor_equations(maneuvers, past, past, longest);
  Eigen::MatrixXd all(out.equations, m + out.n_y);
  all << data.phi, data.z.rightCols(out.n_y);
  Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(all);  // in place
  out.r = all.topLeftCorner(m, m).triangularView<Eigen::Upper>();
  out.b = all.topRightCorner(m, out.n_y);
  const Eigen::Index below = std::min<Eigen::Index>(out.n_y, out.equations - m);
  const Eigen::MatrixXd rest = all.block(m, m, below, out.n_y).triangularView<Eigen::Upper>();
  out.residual = rest.colwise().squaredNorm();
  return out;
}

Result<PredictorMarkov> solve_predictor(const PredictorFactor& factor, const RegularizationOptions& options) {
  if (options.rule == Regularization::fixed) return solve_fixed(factor, options.lambda);
  const SpectralProblem problem = spectral_problem(factor);
  PredictorMarkov out;
  out.lambda = chosen_lambda(problem.spectrum, options.rule);
  const Eigen::ArrayXd s = problem.spectrum.s.array();
  const Eigen::ArrayXd denominator = s.square() + out.lambda * out.lambda;
  out.freedom = (s.square() / denominator).sum();
  out.condition = s(s.size() - 1) > 0.0 ? s(0) / s(s.size() - 1) : std::numeric_limits<double>::infinity();
  out.xi = (problem.v * ((s / denominator).matrix().asDiagonal() * problem.beta)).transpose();
  return out;
}

}  // namespace fatmc
