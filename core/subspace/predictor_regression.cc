#include "core/subspace/predictor_regression.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace fatmc {
namespace {

constexpr double kStrongRobustShare = 0.95;  // gamma
constexpr int kSearchDecades = 12, kSearchPerDecade = 20;

/// Phi^T and Y^T side by side.
Eigen::MatrixXd stacked_regression(std::span<const Maneuver> maneuvers, int past, Eigen::Index equations) {
  const Eigen::Index n_u = maneuvers.front().inputs.cols(), n_y = maneuvers.front().outputs.cols(),
                     n_z = n_u + n_y;
  Eigen::MatrixXd all(equations, past * n_z + n_y);
  Eigen::Index row = 0;
  for (const Maneuver& maneuver : maneuvers) {
    const Eigen::Index rows = maneuver.samples() - past;
    for (int lag = 1; lag <= past; ++lag) {
      all.block(row, (lag - 1) * n_z, rows, n_u) = maneuver.inputs.middleRows(past - lag, rows);
      all.block(row, (lag - 1) * n_z + n_u, rows, n_y) = maneuver.outputs.middleRows(past - lag, rows);
    }
    all.block(row, past * n_z, rows, n_y) = maneuver.outputs.bottomRows(rows);
    row += rows;
  }
  return all;
}

/// Everything the rules need: the problem in the singular directions of R.
struct SpectralProblem {
  Eigen::VectorXd s;       ///< descending
  Eigen::MatrixXd v;       ///< right singular vectors
  Eigen::MatrixXd beta;    ///< left singular vectors^T b
  Eigen::VectorXd energy;  ///< squared rows of beta
  double unexplained = 0.0;
  double equations = 0.0;
};

SpectralProblem spectral_problem(const PredictorFactor& factor) {
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(factor.r, Eigen::ComputeFullU | Eigen::ComputeFullV);
  SpectralProblem out;
  out.s = svd.singularValues();
  out.v = svd.matrixV();
  out.beta = svd.matrixU().transpose() * factor.b;
  out.energy = out.beta.rowwise().squaredNorm();
  out.unexplained = factor.residual.sum();
  out.equations = static_cast<double>(factor.equations);
  return out;
}

struct RidgeSums {
  double rss = 0.0;       ///< ||Y - Xi Phi||^2
  double solution = 0.0;  ///< ||Xi||^2
  double trace = 0.0;     ///< sum f
  double strong = 0.0;    ///< sum (s_1 s/(s^2 + lambda^2))^2
};

RidgeSums ridge_sums(const SpectralProblem& problem, double lambda) {
  RidgeSums sums;
  sums.rss = problem.unexplained;
  for (Eigen::Index i = 0; i < problem.s.size(); ++i) {
    const double s = problem.s(i), denominator = s * s + lambda * lambda;
    if (denominator == 0.0) {
      sums.rss += problem.energy(i);
      continue;
    }
    const double filter = s * s / denominator, rest = lambda * lambda / denominator, gain = s / denominator;
    sums.rss += rest * rest * problem.energy(i);
    sums.solution += gain * gain * problem.energy(i);
    sums.trace += filter;
    sums.strong += gain * gain * problem.s(0) * problem.s(0);
  }
  return sums;
}

double cross_validation(const SpectralProblem& problem, double lambda, bool strong_robust) {
  const RidgeSums sums = ridge_sums(problem, lambda);
  const double m = problem.equations, left = 1.0 - sums.trace / m;
  if (left <= 0.0) return std::numeric_limits<double>::infinity();
  const double value = sums.rss / m / (left * left);
  return strong_robust ? value * (kStrongRobustShare + (1.0 - kStrongRobustShare) * sums.strong / m) : value;
}

std::vector<double> candidate_lambdas(double largest) {
  std::vector<double> out;
  for (int i = -kSearchDecades * kSearchPerDecade; i <= 0; ++i) {
    out.push_back(largest * std::pow(10.0, static_cast<double>(i) / kSearchPerDecade));
  }
  return out;
}

/// Signed curvature of the L-curve at inner points, by differences over log lambda; the corner is where it is
/// largest.
double corner(const SpectralProblem& problem, const std::vector<double>& lambdas) {
  std::vector<double> x, y;
  for (const double lambda : lambdas) {
    const RidgeSums sums = ridge_sums(problem, lambda);
    x.push_back(0.5 * std::log(std::max(sums.rss, std::numeric_limits<double>::min())));
    y.push_back(0.5 * std::log(std::max(sums.solution, std::numeric_limits<double>::min())));
  }
  double best = lambdas.front(), largest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i + 1 < lambdas.size(); ++i) {
    const double dx = 0.5 * (x[i + 1] - x[i - 1]), dy = 0.5 * (y[i + 1] - y[i - 1]);
    const double ddx = x[i + 1] - 2.0 * x[i] + x[i - 1], ddy = y[i + 1] - 2.0 * y[i] + y[i - 1];
    const double speed = dx * dx + dy * dy;
    if (speed <= 0.0) continue;
    const double curvature = (dx * ddy - ddx * dy) / std::pow(speed, 1.5);
    if (curvature > largest) {
      largest = curvature;
      best = lambdas[i];
    }
  }
  return best;
}

double chosen_lambda(const SpectralProblem& problem, Regularization rule) {
  const std::vector<double> lambdas = candidate_lambdas(problem.s(0));
  if (rule == Regularization::lcurve) return corner(problem, lambdas);
  double best = lambdas.front(), smallest = std::numeric_limits<double>::infinity();
  for (const double lambda : lambdas) {
    const double value = cross_validation(problem, lambda, rule == Regularization::srgcv);
    if (value < smallest) {
      smallest = value;
      best = lambda;
    }
  }
  return best;
}

/// Without any singular value: R itself, or [R; lambda I] made triangular again.
Result<PredictorMarkov> solve_fixed(const PredictorFactor& factor, double lambda) {
  const Eigen::Index m = factor.r.rows();
  PredictorMarkov out;
  out.lambda = lambda;
  if (lambda == 0.0) {
    const Eigen::ArrayXd pivots = factor.r.diagonal().array().abs();
    if (pivots.minCoeff() <= 1e-13 * pivots.maxCoeff()) {
      return fail(
          "the regression on the past is singular: give a regularization (gcv, or a lambda above 0), a "
          "shorter past, or "
          "maneuvers that move every input");
    }
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

Result<PredictorFactor> factor_predictor(std::span<const Maneuver> maneuvers, int past) {
  if (Status status = check_maneuvers(maneuvers); !status) return fail(status.error());
  PredictorFactor out;
  out.past = past;
  out.n_u = static_cast<int>(maneuvers.front().inputs.cols());
  out.n_y = static_cast<int>(maneuvers.front().outputs.cols());
  const int largest = largest_past_window(maneuvers);
  Eigen::Index shortest = maneuvers.front().samples();
  for (const Maneuver& maneuver : maneuvers) {
    out.equations += maneuver.samples() - past;
    shortest = std::min(shortest, maneuver.samples());
  }
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
  const Eigen::Index m = static_cast<Eigen::Index>(past) * out.n_z();
  Eigen::MatrixXd all = stacked_regression(maneuvers, past, out.equations);
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
  out.lambda = chosen_lambda(problem, options.rule);
  const Eigen::ArrayXd s = problem.s.array();
  const Eigen::ArrayXd denominator = s.square() + out.lambda * out.lambda;
  out.freedom = (s.square() / denominator).sum();
  out.condition = s(s.size() - 1) > 0.0 ? s(0) / s(s.size() - 1) : std::numeric_limits<double>::infinity();
  out.xi = (problem.v * ((s / denominator).matrix().asDiagonal() * problem.beta)).transpose();
  return out;
}

}  // namespace fatmc
