#include "core/subspace/pbsid_opt.h"

#include <Eigen/QR>
#include <string>
#include <utility>

#include "core/subspace/eigenvalues.h"
#include "core/subspace/riccati.h"

namespace fatmc {
namespace {

/// Rows t = p ... N-2 of all maneuvers.
struct RegressionData {
  Eigen::MatrixXd x, x_next, u, y;
};

RegressionData regression_data(std::span<const Maneuver> maneuvers, const StateMap& map) {
  Eigen::Index rows = 0;
  for (const Maneuver& maneuver : maneuvers) rows += maneuver.samples() - map.past - 1;
  const Eigen::Index n = map.map.rows();
  RegressionData out{Eigen::MatrixXd(rows, n), Eigen::MatrixXd(rows, n),
                     Eigen::MatrixXd(rows, maneuvers.front().inputs.cols()),
                     Eigen::MatrixXd(rows, maneuvers.front().outputs.cols())};
  Eigen::Index row = 0;
  for (const Maneuver& maneuver : maneuvers) {
    const Eigen::MatrixXd x = state_sequence(map, maneuver);
    const Eigen::Index count = x.rows() - 1;
    out.x.middleRows(row, count) = x.topRows(count);
    out.x_next.middleRows(row, count) = x.bottomRows(count);
    out.u.middleRows(row, count) = maneuver.inputs.middleRows(map.past, count);
    out.y.middleRows(row, count) = maneuver.outputs.middleRows(map.past, count);
    row += count;
  }
  return out;
}

/// Theta of Y = X Theta^T by a pivoted QR; fails where the columns of X are dependent.
Result<Eigen::MatrixXd> regress(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y, const char* what) {
  if (x.rows() < x.cols())
    return fail(std::string("fewer samples than ") + what + ": shorten the past or lower the order");
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(x);
  if (qr.rank() < x.cols()) {
    return fail(std::string("the ") + what +
                " are linearly dependent: lower the order, or move the inputs by themselves");
  }
  return Eigen::MatrixXd(qr.solve(y).transpose());
}

Eigen::MatrixXd side_by_side(const Eigen::MatrixXd& left, const Eigen::MatrixXd& right) {
  Eigen::MatrixXd out(left.rows(), left.cols() + right.cols());
  out << left, right;
  return out;
}

Status solve_paper(const RegressionData& data, PbsidModel& model) {
  const Eigen::Index n = data.x.cols(), n_u = data.u.cols();
  const Eigen::MatrixXd regressor = side_by_side(data.x, data.u);
  auto ab = regress(regressor, data.x_next, "states and inputs");
  if (!ab) return fail(ab.error());
  model.a = ab->leftCols(n);
  model.b = ab->rightCols(n_u);
  const Eigen::MatrixXd w = data.x_next - regressor * ab->transpose(),
                        e = data.y - data.x * model.c.transpose();
  const double count = static_cast<double>(data.x.rows());
  const NoiseCovariance noise{w.transpose() * w / count, w.transpose() * e / count,
                              e.transpose() * e / count};
  auto gain = kalman_gain(model.a, model.c, noise);
  if (!gain) return fail(gain.error());
  model.k = gain->k;
  model.riccati_residual = gain->residual;
  return {};
}

Status solve_residual(const RegressionData& data, PbsidModel& model) {
  const Eigen::Index n = data.x.cols(), n_u = data.u.cols();
  const Eigen::MatrixXd e = data.y - data.x * model.c.transpose();
  auto abk =
      regress(side_by_side(side_by_side(data.x, data.u), e), data.x_next, "states, inputs and residuals");
  if (!abk) return fail(abk.error());
  model.a = abk->leftCols(n);
  model.b = abk->middleCols(n, n_u);
  model.k = abk->rightCols(e.cols());
  return {};
}

}  // namespace

Status describe_predictor(int past, PbsidModel& model) {
  const Eigen::MatrixXd a_k = model.a - model.k * model.c;
  const auto eigenvalues = eigenvalues_of(model.a);
  const auto radius = spectral_radius(a_k);
  if (!eigenvalues || !radius) return fail("the identified model is not finite");
  model.eigenvalues = *eigenvalues;
  model.predictor_radius = *radius;
  model.predictor_norm = spectral_norm_of_power(a_k, past);
  return {};
}

Result<PbsidModel> regress_model(std::span<const Maneuver> maneuvers, const StateMap& map,
                                 const PbsidOptions& options) {
  const RegressionData data = regression_data(maneuvers, map);
  PbsidModel model;
  model.singular_values = map.singular_values;
  auto c = regress(data.x, data.y, "states");
  if (!c) return fail(c.error());
  model.c = std::move(*c);
  const Eigen::MatrixXd e = data.y - data.x * model.c.transpose();
  model.innovation = e.transpose() * e / static_cast<double>(e.rows());
  const bool paper = options.final_regression == FinalRegression::paper;
  if (Status status = paper ? solve_paper(data, model) : solve_residual(data, model); !status)
    return fail(status.error());
  if (Status status = describe_predictor(map.past, model); !status) return fail(status.error());
  return model;
}

Result<PbsidModel> identify_pbsid(std::span<const Maneuver> maneuvers, const PbsidOptions& options) {
  auto factor = factor_predictor(maneuvers, options.past);
  if (!factor) return fail(factor.error());
  auto markov = solve_predictor(*factor, options.regularization);
  if (!markov) return fail(markov.error());
  auto map = state_map(*factor, *markov, options.future, options.order);
  if (!map) return fail(map.error());
  auto model = regress_model(maneuvers, *map, options);
  if (!model) return fail(model.error());
  model->lambda = markov->lambda;
  model->freedom = markov->freedom;
  return model;
}

}  // namespace fatmc
