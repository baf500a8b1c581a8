#include "core/subspace/state_moments.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <string>

#include "core/base/check.h"
#include "core/subspace/dense_kernels.h"
#include "core/subspace/riccati.h"

namespace fatmc {
namespace {

constexpr double kRoundOff = 1e-14;   // of the largest singular value, as state_map
constexpr double kDependent = 1e-13;  // reciprocal condition of normal equations with unit diagonal

/// T(:, n_y ...) U: the product of block rows 2 ... f + 1 of LK. A block row beyond p is zero.
Eigen::MatrixXd shifted_product(const PastProducts& products, const Eigen::MatrixXd& u) {
  const Eigen::Index n_y = products.n_y, kept = std::min(u.rows(), products.triangle.rows() - n_y);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(kept + n_y, u.cols());
  if (kept <= 0) return out;
  auto below = out.bottomRows(kept);
  below = u.topRows(kept);
  multiply_triangle(products.triangle.block(n_y, n_y, kept, kept), false, below);
  add_product(products.triangle.block(0, n_y, n_y, kept), u.topRows(kept), out.topRows(n_y));
  return out;
}

/// Theta of the regression with moments `rhs` = sum y x^T on `gram` = sum x x^T, scaled to a unit diagonal.
Result<Eigen::MatrixXd> regress(const Eigen::MatrixXd& gram, const Eigen::MatrixXd& rhs, const char* what) {
  const Eigen::ArrayXd power = gram.diagonal().array();
  if (!(power.minCoeff() > 0.0) || !gram.allFinite() || !rhs.allFinite())
    return fail(std::string("the ") + what + " do not all move");
  const Eigen::VectorXd scale = power.rsqrt();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * gram * scale.asDiagonal();
  const Eigen::LLT<Eigen::MatrixXd> llt(scaled);
  if (llt.info() != Eigen::Success || !(llt.rcond() > kDependent)) {
    return fail(std::string("the ") + what +
                " are linearly dependent: lower the order, or move the inputs by themselves");
  }
  return Eigen::MatrixXd(llt.solve(scale.asDiagonal() * rhs.transpose()).transpose() * scale.asDiagonal());
}

/// Leading n states of the moments, with y and u apart.
struct OrderMoments {
  Eigen::MatrixXd vv, vu, vy, next_v, next_u, next_y, next_next, uu, uy, yy;

  OrderMoments(const StateMoments& m, Eigen::Index n)
      : vv(m.vv.topLeftCorner(n, n)),
        vu(m.vz.topLeftCorner(n, m.n_u)),
        vy(m.vz.topRightCorner(n, m.n_y).topRows(n)),
        next_v(m.next_v.topLeftCorner(n, n)),
        next_u(m.next_z.topLeftCorner(n, m.n_u)),
        next_y(m.next_z.topRightCorner(n, m.n_y).topRows(n)),
        next_next(m.next_next.topLeftCorner(n, n)),
        uu(m.zz.topLeftCorner(m.n_u, m.n_u)),
        uy(m.zz.topRightCorner(m.n_u, m.n_y)),
        yy(m.zz.bottomRightCorner(m.n_y, m.n_y)) {}
};

Eigen::MatrixXd symmetric(const Eigen::MatrixXd& m) { return 0.5 * (m + m.transpose()); }

/// In the coordinates v; `gain` stays empty with the paper's regression.
struct ScaledModel {
  Eigen::MatrixXd a, b, c, k;
  NoiseCovariance noise;  ///< paper alone
  Eigen::MatrixXd innovation;
};

Status solve_paper(const OrderMoments& m, double samples, ScaledModel& model) {
  const Eigen::Index n = m.vv.rows(), n_u = m.uu.rows();
  Eigen::MatrixXd gram(n + n_u, n + n_u), next(n, n + n_u), with_y(n + n_u, m.yy.rows());
  gram << m.vv, m.vu, m.vu.transpose(), m.uu;
  next << m.next_v, m.next_u;
  with_y << m.vy, m.uy;
  const auto ab = regress(gram, next, "states and inputs");
  if (!ab) return fail(ab.error());
  model.a = ab->leftCols(n);
  model.b = ab->rightCols(n_u);
  // Residuals w are orthogonal to [v; u]: sum w w^T = sum w v+^T, sum w e^T = sum w y^T.
  model.noise.q = symmetric(m.next_next - *ab * next.transpose()) / samples;
  model.noise.s = (m.next_y - *ab * with_y) / samples;
  model.noise.r = model.innovation;
  return {};
}

Status solve_residual(const OrderMoments& m, double samples, ScaledModel& model) {
  const Eigen::Index n = m.vv.rows(), n_u = m.uu.rows(), n_y = m.yy.rows();
  const Eigen::MatrixXd ve = Eigen::MatrixXd::Zero(n, n_y);  // C is a least-squares solution
  const Eigen::MatrixXd ue = m.uy - m.vu.transpose() * model.c.transpose(), ee = model.innovation * samples;
  Eigen::MatrixXd gram(n + n_u + n_y, n + n_u + n_y), next(n, n + n_u + n_y);
  gram << m.vv, m.vu, ve, m.vu.transpose(), m.uu, ue, ve.transpose(), ue.transpose(), ee;
  next << m.next_v, m.next_u, m.next_y - m.next_v * model.c.transpose();
  const auto abk = regress(gram, next, "states, inputs and residuals");
  if (!abk) return fail(abk.error());
  model.a = abk->leftCols(n);
  model.b = abk->middleCols(n, n_u);
  model.k = abk->rightCols(n_y);
  return {};
}

}  // namespace

StateMoments state_moments(const PastProducts& products, const LeadingTriplets& leading, int future,
                           int states) {
  const Eigen::Index n_y = products.n_y, size = future * n_y,
                     n = std::min<Eigen::Index>(states, leading.u.cols());
  FATMC_CHECK(future >= 1 && future <= products.past && leading.u.rows() == size, "state_moments: future");
  StateMoments out;
  out.past = products.past;
  out.n_u = products.n_u;
  out.n_y = products.n_y;
  out.samples = static_cast<double>(products.samples);
  out.s = leading.s.head(n);
  const Eigen::MatrixXd u = leading.u.leftCols(n), shifted = shifted_product(products, u);
  // S^-1 U^T
  const Eigen::MatrixXd rows = out.s.cwiseInverse().asDiagonal() * u.transpose();
  const Eigen::MatrixXd w = leading.w.leftCols(n),  // T U S^-1
      shifted_scaled = shifted * out.s.cwiseInverse().asDiagonal();
  const Eigen::Index common = std::min(w.rows(), shifted.rows());
  const Eigen::MatrixXd g = rows * products.first_column.topRows(size),
                        shifted_z = rows * products.states_z.middleRows(n_y, size),
                        last_v = rows * products.last_states.topRows(size),
                        last_next = g * products.last_z + rows * products.last_states.middleRows(n_y, size);
  out.vv = transposed_product(w, w) - last_v * last_v.transpose();
  out.vz = rows * products.states_z.topRows(size);
  out.next_z = g * products.zz + shifted_z - last_next * products.last_z.transpose();
  out.next_v = g * out.vz.transpose() +
               transposed_product(shifted_scaled.topRows(common), w.topRows(common)) -
               last_next * last_v.transpose();
  out.vz -= last_v * products.last_z.transpose();
  out.next_next = g * products.zz * g.transpose() + g * shifted_z.transpose() + shifted_z * g.transpose() +
                  transposed_product(shifted_scaled, shifted_scaled) - last_next * last_next.transpose();
  out.zz = products.zz - products.last_z * products.last_z.transpose();
  return out;
}

Result<PbsidModel> moment_model(const StateMoments& moments, int order, FinalRegression final_regression) {
  if (order < 1 || order > moments.s.size()) {
    return fail("an order of " + std::to_string(order) + " cannot be had from these windows, which carry " +
                std::to_string(moments.s.size()) + ": lengthen the future");
  }
  if (!(moments.s(order - 1) > kRoundOff * moments.s(0))) {
    return fail("singular value " + std::to_string(order) +
                " is round-off of the first: the order is too high for these data");
  }
  const OrderMoments m(moments, order);
  ScaledModel scaled;
  auto c = regress(m.vv, m.vy.transpose(), "states");
  if (!c) return fail(c.error());
  scaled.c = std::move(*c);
  scaled.innovation = symmetric(m.yy - scaled.c * m.vy) / moments.samples;
  const bool paper = final_regression == FinalRegression::paper;
  if (Status status =
          paper ? solve_paper(m, moments.samples, scaled) : solve_residual(m, moments.samples, scaled);
      !status)
    return fail(status.error());
  const Eigen::VectorXd root = moments.s.head(order).array().sqrt(), inverse = root.cwiseInverse();
  PbsidModel model;
  model.a = root.asDiagonal() * scaled.a * inverse.asDiagonal();
  model.b = root.asDiagonal() * scaled.b;
  model.c = scaled.c * inverse.asDiagonal();
  model.innovation = scaled.innovation;
  model.singular_values = moments.s;
  if (paper) {
    const NoiseCovariance noise{root.asDiagonal() * scaled.noise.q * root.asDiagonal(),
                                root.asDiagonal() * scaled.noise.s, scaled.noise.r};
    const auto gain = kalman_gain(model.a, model.c, noise);
    if (!gain) return fail(gain.error());
    model.k = gain->k;
    model.riccati_residual = gain->residual;
  } else {
    model.k = root.asDiagonal() * scaled.k;
  }
  if (Status status = describe_predictor(moments.past, model); !status) return fail(status.error());
  return model;
}

}  // namespace fatmc
