#include "core/subspace/past_products.h"

#include <algorithm>

#include "core/subspace/dense_kernels.h"
#include "core/subspace/predictor_regression.h"

namespace fatmc {
namespace {

constexpr int kLags = 20;  // lags whose rows enter T at a time

/// Lags first ... first + lags - 1 of LK^T, lags n_z x (p - first) n_y. `padded`: Xi^T, p n_z x n_y, with
/// zeros below.
Eigen::MatrixXd hankel_rows(const Eigen::MatrixXd& padded, int n_z, int past, int first, int lags) {
  const Eigen::Index n_y = padded.cols(), height = static_cast<Eigen::Index>(lags) * n_z;
  Eigen::MatrixXd out(height, (past - first) * n_y);
  for (Eigen::Index i = 0; i < past - first; ++i)
    out.middleCols(i * n_y, n_y) = padded.middleRows((first + i) * n_z, height);
  return out;
}

/// T of P^T = R LK^T, from the last rows to the first.
Eigen::MatrixXd product_triangle(const NestedRegression& regression, const Eigen::MatrixXd& xi) {
  const int past = regression.past(), n_z = regression.n_z(), n_y = regression.n_y();
  const Eigen::Index m = regression.unknowns();
  Eigen::MatrixXd padded = Eigen::MatrixXd::Zero(m + static_cast<Eigen::Index>(kLags) * n_z, n_y);
  padded.topRows(m) = xi.transpose();
  Eigen::MatrixXd triangle = zero_triangle(static_cast<Eigen::Index>(past) * n_y);
  const auto r = regression.r();
  for (int first = (past - 1) / kLags * kLags; first >= 0; first -= kLags) {
    const int lags = std::min(kLags, past - first);
    const Eigen::Index columns = static_cast<Eigen::Index>(past - first) * n_y;
    Eigen::MatrixXd rows = hankel_rows(padded, n_z, past, first, lags);
    multiply_triangle(r.block(first * n_z, first * n_z, lags * n_z, lags * n_z), false, rows);
    for (int inner = first + kLags; inner < past; inner += kLags) {
      const int inner_lags = std::min(kLags, past - inner);
      add_product(r.block(first * n_z, inner * n_z, lags * n_z, inner_lags * n_z),
                  hankel_rows(padded, n_z, past, inner, inner_lags),
                  rows.leftCols(static_cast<Eigen::Index>(past - inner) * n_y));
    }
    append_rows(triangle.topLeftCorner(columns, columns), rows);
  }
  return triangle;
}

/// LK x with a block row of zeros below.
Eigen::MatrixXd hankel_product(const Eigen::MatrixXd& xi, int n_z, const Eigen::MatrixXd& x) {
  const Eigen::Index n_y = xi.rows(), past = xi.cols() / n_z;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero((past + 1) * n_y, x.cols());
  for (Eigen::Index i = 0; i < past; ++i) {
    const Eigen::Index width = xi.cols() - i * n_z;
    add_product(xi.rightCols(width), x.topRows(width), out.middleRows(i * n_y, n_y));
  }
  return out;
}

}  // namespace

PastProducts past_products(const NestedRegression& regression, std::span<const Maneuver> maneuvers,
                           const Eigen::MatrixXd& xi) {
  const int past = regression.past(), n_z = regression.n_z(), n_y = regression.n_y();
  PastProducts out;
  out.past = past;
  out.n_u = regression.n_u();
  out.n_y = n_y;
  out.triangle = product_triangle(regression, xi);
  out.first_column.resize(static_cast<Eigen::Index>(past) * n_y, n_z);
  for (Eigen::Index i = 0; i < past; ++i)
    out.first_column.middleRows(i * n_y, n_y) = xi.middleCols(i * n_z, n_z);
  Eigen::MatrixXd phi_z = regression.b();
  multiply_triangle(regression.r(), true, phi_z);  // sum phi z^T = R^T B
  out.states_z = hankel_product(xi, n_z, phi_z);
  const auto count = static_cast<Eigen::Index>(maneuvers.size());
  Eigen::MatrixXd last_phi(regression.unknowns(), count);
  out.last_z.resize(n_z, count);
  out.zz = Eigen::MatrixXd::Zero(n_z, n_z);
  for (Eigen::Index j = 0; j < count; ++j) {
    const std::span<const Maneuver> one = maneuvers.subspan(static_cast<std::size_t>(j), 1);
    const Maneuver& maneuver = one.front();
    const Eigen::Index rows = maneuver.samples() - past;
    const PredictorEquations last =
        predictor_equations(one, past, maneuver.samples() - 1, maneuver.samples());
    last_phi.col(j) = last.phi.row(0).transpose();
    out.last_z.col(j) = last.z.row(0).transpose();
    Eigen::MatrixXd z(rows, n_z);
    z << maneuver.inputs.bottomRows(rows), maneuver.outputs.bottomRows(rows);
    out.zz.noalias() += z.transpose() * z;
    out.samples += rows - 1;
  }
  out.last_states = hankel_product(xi, n_z, last_phi);
  return out;
}

}  // namespace fatmc
