#include "core/subspace/model_fit.h"

#include <Eigen/QR>
#include <cmath>

namespace fatmc {
namespace {

/// The most leading modal states, at most `wanted`, that cut no pair.
Eigen::Index whole_modes(const Eigen::VectorXcd& eigenvalues, int wanted) {
  Eigen::Index count = 0;
  while (count < eigenvalues.size()) {
    const Eigen::Index next = count + (eigenvalues(count).imag() != 0.0 ? 2 : 1);
    if (next > wanted) break;
    count = next;
  }
  return count;
}

/// [C A^t restricted to the free states, I], samples stacked output by output.
Eigen::MatrixXd start_regressor(const DiscreteModel& modal, Eigen::Index free, Eigen::Index samples) {
  const Eigen::Index n_y = modal.c.rows();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(samples * n_y, free + n_y);
  Eigen::MatrixXd row = modal.c.leftCols(free);
  const Eigen::MatrixXd a =
      modal.a.topLeftCorner(free, free);  // block diagonal: the free modes stay among themselves
  for (Eigen::Index t = 0; t < samples; ++t) {
    out.block(t * n_y, 0, n_y, free) = row;
    out.block(t * n_y, free, n_y, n_y).setIdentity();
    row = (row * a).eval();
  }
  return out;
}

}  // namespace

Eigen::MatrixXd simulate(const DiscreteModel& model, const Eigen::Ref<const Eigen::MatrixXd>& inputs) {
  Eigen::MatrixXd out(inputs.rows(), model.c.rows());
  Eigen::VectorXd x = Eigen::VectorXd::Zero(model.a.rows()), next(model.a.rows());
  for (Eigen::Index t = 0; t < inputs.rows(); ++t) {
    out.row(t).noalias() = (model.c * x).transpose();
    next.noalias() = model.a * x;
    next.noalias() += model.b * inputs.row(t).transpose();
    x.swap(next);
  }
  return out;
}

Result<ModelFit> fit_maneuver(const DiscreteModel& model, const Maneuver& maneuver, int free_states) {
  const auto modal = modal_model(model);
  if (!modal) return fail(modal.error());
  return fit_maneuver(*modal, maneuver, free_states);
}

Result<ModelFit> fit_maneuver(const ModalModel& modal, const Maneuver& maneuver, int free_states) {
  ModelFit out;
  out.outputs = simulate(modal.model, maneuver.inputs);
  const Eigen::Index n_y = modal.model.c.rows(), samples = maneuver.samples(),
                     free = whole_modes(modal.eigenvalues, free_states);
  Eigen::MatrixXd regressor = start_regressor(modal.model, free, samples);
  if (!out.outputs.allFinite() || !regressor.allFinite()) {
    return fail("the simulated maneuver is not finite: the model is unstable");
  }
  const Eigen::MatrixXd error =
      (maneuver.outputs - out.outputs).transpose();  // n_y x samples, column by column a sample
  const Eigen::Map<const Eigen::VectorXd> rhs(error.data(), error.size());
  Eigen::VectorXd scale = regressor.colwise().norm();
  scale = (scale.array() > 0.0).select(scale, 1.0);
  const Eigen::MatrixXd scaled = regressor * scale.cwiseInverse().asDiagonal();
  const Eigen::VectorXd start =
      Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(scaled).solve(rhs).cwiseQuotient(scale);
  const Eigen::VectorXd added = regressor * start;
  out.outputs += Eigen::Map<const Eigen::MatrixXd>(added.data(), n_y, samples).transpose();
  out.x0 = start.head(free);
  out.y0 = start.tail(n_y);
  if (!out.outputs.allFinite()) return fail("the simulated maneuver is not finite: the model is unstable");
  return out;
}

double variance_accounted_for(const Eigen::Ref<const Eigen::VectorXd>& measured,
                              const Eigen::Ref<const Eigen::VectorXd>& simulated) {
  const Eigen::ArrayXd error = (measured - simulated).array();
  const double rest = (error - error.mean()).square().sum();
  return 100.0 * (1.0 - rest / (measured.array() - measured.mean()).square().sum());
}

double rms_error(const Eigen::Ref<const Eigen::MatrixXd>& measured,
                 const Eigen::Ref<const Eigen::MatrixXd>& simulated) {
  return std::sqrt((measured - simulated).squaredNorm() / static_cast<double>(measured.size()));
}

std::string_view rms_rating(double j_rms) {
  if (j_rms < 1.0) return "excellent";
  if (j_rms < 2.0) return "good";
  return j_rms <= 3.5 ? "adequate" : "inadequate";
}

std::string_view agreement_rating(double d1) {
  if (d1 >= 0.94) return "excellent";
  if (d1 >= 0.89) return "good";
  return d1 >= 0.80 ? "adequate" : "inadequate";
}

}  // namespace fatmc
