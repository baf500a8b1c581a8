#include "core/subspace/state_sequence.h"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <string>

namespace fatmc {
namespace {

constexpr double kRoundOff = 1e-14;  // of the largest singular value

struct LeftSingular {
  Eigen::MatrixXd u;
  Eigen::VectorXd s;
};

/// Left singular vectors of a wide or square matrix from the triangle of its transpose.
LeftSingular left_singular(const Eigen::MatrixXd& product) {
  const Eigen::Index small = std::min(product.rows(), product.cols());
  Eigen::MatrixXd transposed = product.transpose();
  Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(transposed);
  const Eigen::MatrixXd triangle = transposed.topRows(small).triangularView<Eigen::Upper>();
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(triangle,
                                           Eigen::ComputeThinV);  // (product^T = Q T): right vectors of T
  return {svd.matrixV(), svd.singularValues()};
}

}  // namespace

Eigen::MatrixXd shifted_markov(const PredictorMarkov& markov, int n_z, int future) {
  const Eigen::Index n_y = markov.xi.rows(), width = markov.xi.cols();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(future * n_y, width);
  for (int i = 0; i < future; ++i) {
    const Eigen::Index kept = width - static_cast<Eigen::Index>(i) * n_z;
    out.block(i * n_y, 0, n_y, kept) = markov.xi.rightCols(kept);
  }
  return out;
}

Result<StateMap> state_map(const PredictorFactor& factor, const PredictorMarkov& markov, int future,
                           int order) {
  if (future < 1 || future > factor.past) {
    return fail("the future window is " + std::to_string(future) +
                ", it lies between 1 and the past window, " + std::to_string(factor.past));
  }
  const int most = std::min(future * factor.n_y, factor.past * factor.n_z());
  if (order < 1 || order > most) {
    return fail("an order of " + std::to_string(order) +
                " cannot be had from these windows, it lies between 1 and " + std::to_string(most) +
                ": lengthen the future");
  }
  const Eigen::MatrixXd product_ok = shifted_markov(markov, factor.n_z(), future);
  const Eigen::MatrixXd product = product_ok * factor.r.triangularView<Eigen::Upper>().transpose();
  if (!product.allFinite()) return fail("the predictor Markov parameters are not finite");
  const LeftSingular svd = left_singular(product);
  if (!(svd.s(order - 1) > kRoundOff * svd.s(0))) {
    return fail("singular value " + std::to_string(order) +
                " is round-off of the first: the order is too high for these data");
  }
  StateMap out;
  out.past = factor.past;
  out.singular_values = svd.s;
  out.map = svd.s.head(order).array().rsqrt().matrix().asDiagonal() *
            (svd.u.leftCols(order).transpose() * product_ok);
  return out;
}

Eigen::MatrixXd state_sequence(const StateMap& map, const Maneuver& maneuver) {
  const Eigen::Index n_u = maneuver.inputs.cols(), n_y = maneuver.outputs.cols(),
                     rows = maneuver.samples() - map.past;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows, map.map.rows());
  for (int lag = 1; lag <= map.past; ++lag) {
    const Eigen::Index column = (lag - 1) * (n_u + n_y);
    out.noalias() +=
        maneuver.inputs.middleRows(map.past - lag, rows) * map.map.middleCols(column, n_u).transpose();
    out.noalias() +=
        maneuver.outputs.middleRows(map.past - lag, rows) * map.map.middleCols(column + n_u, n_y).transpose();
  }
  return out;
}

}  // namespace fatmc
