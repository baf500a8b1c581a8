#include "tools/fit_problem.h"

#include <cmath>

namespace fatmc::fit {
namespace {

Aircraft aircraft_at(const Problem& problem, const Eigen::VectorXd& scaled) {
  Aircraft out = problem.start;
  for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
    const Parameter& p = problem.parameters[i];
    p.of(out) = p.prior + p.spread * scaled[static_cast<Eigen::Index>(i)];
  }
  return out;
}

/// `loosening`: of the targets' tolerances.
Eigen::VectorXd residuals(const Problem& problem, double loosening, const Eigen::VectorXd& scaled) {
  const Eigen::VectorXd model = problem.model(aircraft_at(problem, scaled));
  Eigen::VectorXd out(model.size() + scaled.size());
  for (Eigen::Index i = 0; i < model.size(); ++i) {
    const Target& target = problem.targets[static_cast<std::size_t>(i)];
    out[i] = (model[i] - target.value) / (loosening * target.tolerance);
  }
  out.tail(scaled.size()) = scaled;
  return out;
}

Eigen::MatrixXd jacobian(const Problem& problem, double loosening, const Eigen::VectorXd& scaled, Eigen::Index rows) {
  constexpr double h = 1e-4;
  Eigen::MatrixXd out(rows, scaled.size());
  for (Eigen::Index j = 0; j < scaled.size(); ++j) {
    Eigen::VectorXd up = scaled;
    Eigen::VectorXd down = scaled;
    up[j] += h;
    down[j] -= h;
    out.col(j) = (residuals(problem, loosening, up) - residuals(problem, loosening, down)) / (2.0 * h);
  }
  return out;
}

/// One Levenberg-Marquardt run from x on.
void descend(const Problem& problem, double loosening, Eigen::VectorXd& x, Fit& fit) {
  constexpr int most_iterations = 3000;
  constexpr double small_step = 1e-9;
  Eigen::VectorXd r = residuals(problem, loosening, x);
  double damping = 1e-2;
  fit.converged = false;
  for (int iteration = 0; iteration < most_iterations && !fit.converged; ++iteration) {
    ++fit.iterations;
    const Eigen::MatrixXd j = jacobian(problem, loosening, x, r.size());
    bool better = false;
    for (int trial = 0; trial < 40 && !better; ++trial) {
      // min |J s + r|^2 + damping |D s|^2, D the norms of the columns, by QR of the stacked system
      Eigen::MatrixXd stacked(j.rows() + j.cols(), j.cols());
      stacked << j, Eigen::MatrixXd((std::sqrt(damping) * j.colwise().norm().transpose()).asDiagonal());
      Eigen::VectorXd right = Eigen::VectorXd::Zero(stacked.rows());
      right.head(r.size()) = -r;
      const Eigen::VectorXd step = stacked.colPivHouseholderQr().solve(right);
      const Eigen::VectorXd candidate = residuals(problem, loosening, x + step);
      fit.step = step.cwiseAbs().maxCoeff();
      better = candidate.allFinite() && candidate.squaredNorm() < r.squaredNorm();
      if (better) {
        x += step;
        r = candidate;
      }
      damping = std::max(damping * (better ? 0.1 : 10.0), 1e-18);
      if (fit.step < small_step) break;
    }
    fit.converged = fit.step < small_step;
    if (!better) break;
  }
}

}  // namespace

Fit solve(const Problem& problem) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(problem.parameters.size()));
  Fit fit;
  // Loose first: with tight tolerances from the start the path would creep along a curved valley.
  for (const double loosening : {1e5, 1e4, 1e3, 1e2, 1e1, 1.0}) descend(problem, loosening, x, fit);
  fit.aircraft = aircraft_at(problem, x);
  fit.reached = problem.model(fit.aircraft);
  return fit;
}

}  // namespace fatmc::fit
