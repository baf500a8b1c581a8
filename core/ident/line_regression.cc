#include "core/ident/line_regression.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>
#include <limits>

#include "core/base/check.h"

namespace fatmc {

LineRegression regress_line(const Eigen::Ref<const Eigen::MatrixXcd>& regressor,
                            const Eigen::Ref<const Eigen::MatrixXcd>& channels, int n_in) {
  const Eigen::Index p = regressor.cols(), rows = regressor.rows(), n = n_in, n_z = channels.cols();
  FATMC_CHECK(rows >= p && p >= n && channels.rows() == rows, "a determined problem");
  LineRegression out;
  const Eigen::VectorXd length = regressor.colwise().norm();
  const auto singular = [&] {
    out.condition = std::numeric_limits<double>::infinity();
    out.G_Z.setZero(n_z, n);
    out.A.setZero(n, n);
    out.C_Z.setZero(rows > p ? n_z : 0, rows > p ? n_z : 0);
    return out;
  };
  if (!(length.minCoeff() > 0.0)) return singular();
  const Eigen::HouseholderQR<Eigen::MatrixXcd> qr(regressor * length.cwiseInverse().asDiagonal());
  const Eigen::VectorXd diagonal = qr.matrixQR().diagonal().cwiseAbs();
  out.condition = diagonal.maxCoeff() / diagonal.minCoeff();
  if (!(out.condition < kSingularCondition)) return singular();
  const Eigen::MatrixXcd rotated = qr.householderQ().adjoint() * channels;
  Eigen::MatrixXcd inverse = Eigen::MatrixXcd::Identity(n, n);
  qr.matrixQR().block(p - n, p - n, n, n).triangularView<Eigen::Upper>().solveInPlace(inverse);
  inverse = length.tail(n).cwiseInverse().asDiagonal() * inverse;
  out.G_Z = (inverse * rotated.middleRows(p - n, n)).transpose();
  out.A = inverse * inverse.adjoint();
  if (rows > p) {
    const Eigen::MatrixXcd residual = rotated.bottomRows(rows - p).transpose();
    out.C_Z = residual * residual.adjoint() / static_cast<double>(rows - p);
  }
  return out;
}

void size_estimate(FrmEstimate& e) {
  const int lines = e.line_count(), n_z = e.n_out + e.n_in, n_c = e.indirect ? n_z : e.n_out;
  const auto count = static_cast<std::size_t>(lines);
  e.G.resize(e.n_out, e.n_in, lines);
  e.B.resize(e.n_in, e.n_in, lines);
  e.C_V.resize(e.n_out, e.n_out, lines);
  e.C_Z.resize(n_c, n_c, lines);
  e.C_Z_noise.resize(n_z, n_z, lines);
  e.C_V_noise.resize(e.n_out, e.n_out, lines);
  e.U_mean.resize(e.n_in, 1, lines);
  e.input_snr.resize(e.n_in, 1, lines);
  e.outlier.resize(e.n_in, 1, lines);
  e.status.assign(count, LineStatus::ok);
  e.border.assign(count, 0);
  e.regressor_condition.assign(count, 0.0);
  e.input_condition.assign(count, 1.0);
}

namespace {

/// Whether the line has an estimate; G, B and C_V are written where it has.
LineStatus solve_line(FrmEstimate& e, int k, const LineRegression& r) {
  const auto at = static_cast<std::size_t>(k);
  e.regressor_condition[at] = r.condition;
  if (!(r.condition < kSingularCondition)) return LineStatus::singular_regressor;
  Eigen::MatrixXcd g = r.G_Z.topRows(e.n_out), b = r.A;
  if (e.indirect) {
    const Eigen::MatrixXcd g_ur = r.G_Z.bottomRows(e.n_in);
    const Eigen::FullPivLU<Eigen::MatrixXcd> lu(g_ur);
    const Eigen::VectorXd pivots = lu.matrixLU().diagonal().cwiseAbs();
    if (!(pivots.minCoeff() * kSingularCondition > pivots.maxCoeff())) {
      e.input_condition[at] = std::numeric_limits<double>::infinity();
      return LineStatus::singular_input;
    }
    const Eigen::MatrixXcd inverse = lu.inverse();
    e.input_condition[at] = g_ur.norm() * inverse.norm();
    g = g * inverse;
    b = inverse.transpose() * r.A * inverse.conjugate();
  }
  Eigen::MatrixXcd v(e.n_out, e.n_out + e.n_in);
  v << Eigen::MatrixXcd::Identity(e.n_out, e.n_out), -g;
  e.G[k] = g;
  e.B[k] = b;
  e.C_V_noise[k] = v * e.C_Z_noise[k] * v.adjoint();
  if (r.C_Z.size() == 0) {
    e.C_V[k] = e.C_V_noise[k];
    e.C_Z[k] = e.C_Z_noise[k].topLeftCorner(e.C_Z.rows(), e.C_Z.cols());
  } else {
    e.C_Z[k] = r.C_Z;
    if (e.indirect) {
      e.C_V[k] = v * r.C_Z * v.adjoint();
    } else {
      e.C_V[k] = r.C_Z;
    }
  }
  return LineStatus::ok;
}

}  // namespace

void store_line(FrmEstimate& e, int k, const LineRegression& regression) {
  const LineStatus status = solve_line(e, k, regression);
  e.status[static_cast<std::size_t>(k)] = status;
  if (status == LineStatus::ok) return;
  e.G[k].setZero();
  e.B[k].setZero();
  e.C_V[k].setZero();
  e.C_Z[k].setZero();
  e.C_V_noise[k].setZero();
}

void store_input_quality(FrmEstimate& e, int k, const Eigen::Ref<const Eigen::VectorXcd>& inputs) {
  for (int j = 0; j < e.n_in; ++j) {
    const double deviation = std::sqrt(std::max(0.0, e.C_Z_noise[k](e.n_out + j, e.n_out + j).real()));
    const double magnitude = std::abs(inputs(j));
    e.U_mean[k](j, 0) = inputs(j);
    e.input_snr[k](j, 0) =
        deviation > 0.0 ? (magnitude - deviation) / deviation : std::numeric_limits<double>::infinity();
    e.outlier[k](j, 0) = magnitude < 3.0 * deviation ? 1 : 0;
  }
}

}  // namespace fatmc
