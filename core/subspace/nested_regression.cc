#include "core/subspace/nested_regression.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/subspace/dense_kernels.h"
#include "core/subspace/predictor_regression.h"
#include "core/subspace/singular_rotation.h"

namespace fatmc {
namespace {

constexpr Eigen::Index kRidgeRows = 256;  // of lambda I at a time

}  // namespace

NestedRegression::NestedRegression(std::span<const Maneuver> maneuvers, int past)
    : maneuvers_(maneuvers),
      past_(past),
      n_u_(static_cast<int>(maneuvers.front().inputs.cols())),
      n_y_(static_cast<int>(maneuvers.front().outputs.cols())) {
  Eigen::Index longest = 0;
  for (const Maneuver& maneuver : maneuvers) longest = std::max(longest, maneuver.samples());
  PredictorEquations data = predictor_equations(maneuvers, past, past, longest);
  const Eigen::Index m = unknowns(), rows = data.phi.rows();
  triangularise(data.phi, data.z);
  plain_.r = upper_triangle(data.phi.topRows(m));
  plain_.b = data.z.topRows(m);
  residual_ = data.z.bottomRightCorner(rows - m, n_y_).colwise().squaredNorm();
}

Result<NestedRegression> NestedRegression::make(std::span<const Maneuver> maneuvers, int past) {
  if (Status status = check_past_window(maneuvers, past); !status) return fail(status.error());
  return NestedRegression(maneuvers, past);
}

Eigen::Index NestedRegression::equations() const {
  Eigen::Index count = 0;
  for (const Maneuver& maneuver : maneuvers_) count += maneuver.samples() - past_;
  return count;
}

void NestedRegression::append(Triangle& triangle, const Eigen::MatrixXd& rows, const Eigen::MatrixXd& rhs,
                              bool residual) {
  const Eigen::Index m = unknowns();
  Eigen::MatrixXd reflected = rows, rest = rhs;
  append_rows(triangle.r.topLeftCorner(m, m), triangle.b.topRows(m), reflected, rest);
  if (residual) residual_ += rest.rightCols(n_y_).colwise().squaredNorm().transpose();
}

void NestedRegression::shorten(int past) {
  FATMC_CHECK(past >= 1 && past <= past_, "windows are shortened");
  if (past == past_) return;
  const Eigen::Index longer = unknowns();
  const int from = past, to = past_;
  past_ = past;
  // What only the dropped lags explained is unexplained now.
  residual_ +=
      plain_.b.block(unknowns(), n_u_, longer - unknowns(), n_y_).colwise().squaredNorm().transpose();
  const PredictorEquations freed = predictor_equations(maneuvers_, past, from, to);
  append(plain_, freed.phi, freed.z, true);
  if (ridge_lambda_) append(ridge_, freed.phi, freed.z, false);
}

Result<double> NestedRegression::chosen(Regularization rule) {
  const Eigen::Index m = unknowns();
  ridge_lambda_.reset();
  ridge_.r.resize(0, 0);
  Eigen::MatrixXd square = upper_triangle(r());
  Eigen::MatrixXd beta = plain_.b.block(0, n_u_, m, n_y_);
  RidgeSpectrum spectrum;
  if (!rotate_to_singular_directions(square, beta, spectrum.s))
    return fail("the singular values of the regression on the past did not converge");
  spectrum.energy = beta.rowwise().squaredNorm();
  spectrum.unexplained = residual_.sum();
  spectrum.equations = static_cast<double>(equations());
  return chosen_lambda(spectrum, rule);
}

void NestedRegression::factor_ridge(double lambda) {
  const Eigen::Index m = unknowns();
  ridge_.r = upper_triangle(r());
  ridge_.b = plain_.b.topRows(m);
  for (Eigen::Index first = 0; first < m; first += kRidgeRows) {
    // Rows of lambda I touch nothing left of their own columns.
    const Eigen::Index count = std::min(kRidgeRows, m - first), right = m - first;
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(count, right), rest = Eigen::MatrixXd::Zero(count, n_z());
    rows.diagonal().setConstant(lambda);
    append_rows(ridge_.r.bottomRightCorner(right, right), ridge_.b.bottomRows(right), rows, rest);
  }
  ridge_lambda_ = lambda;
}

Result<NestedRegression::Solution> NestedRegression::solve(const RegularizationOptions& options) {
  const Eigen::Index m = unknowns();
  Solution out;
  out.lambda = options.lambda;
  if (options.rule != Regularization::fixed) {
    const Result<double> lambda = chosen(options.rule);
    if (!lambda) return fail(lambda.error());
    out.lambda = *lambda;
  }
  if (out.lambda == 0.0) {
    if (Status status = check_pivots(plain_.r.topLeftCorner(m, m).diagonal()); !status)
      return fail(status.error());
  } else if (ridge_lambda_ != out.lambda) {
    factor_ridge(out.lambda);
  }
  const Triangle& triangle = out.lambda == 0.0 ? plain_ : ridge_;
  Eigen::MatrixXd solution = triangle.b.block(0, n_u_, m, n_y_);
  solve_triangle(triangle.r.topLeftCorner(m, m), solution);
  out.xi = solution.transpose();
  if (!out.xi.allFinite()) return fail("the predictor Markov parameters are not finite");
  return out;
}

}  // namespace fatmc
