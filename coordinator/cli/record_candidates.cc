#include "coordinator/cli/record_candidates.h"

#include <algorithm>
#include <cmath>

#include "campaigns/candidates/maneuver_validation.h"
#include "core/stats/empirical.h"
#include "core/subspace/eigenvalues.h"
#include "core/subspace/model_fit.h"

namespace fatmc::cli {
namespace {

using candidates::ModelRow;
using candidates::ModelState;

constexpr double kCovering = 1.96;

/// The validation maneuvers, and all their outputs as measured.
struct ValidationData {
  std::vector<Maneuver> maneuvers;
  Eigen::MatrixXd measured;
  std::vector<double> weights;
};

Result<Eigen::MatrixXd> simulated(const DiscreteModel& model, const ValidationData& data) {
  const auto modal = modal_model(model);
  if (!modal) return fail(modal.error());
  return candidates::repeated_outputs(*modal, data.maneuvers);
}

void judge(const FamilyMember& member, const Result<PbsidModel>& model, const ValidationData& data,
           RecordCandidates& out) {
  ModelRow row{member.past, member.future, member.order};
  out.models.emplace_back();
  const auto failed = [&](ModelState state, const Error& error) {
    row.state = state;
    if (out.first_failure.empty())
      out.first_failure = "p " + std::to_string(member.past) + ", f " + std::to_string(member.future) +
                          ", n " + std::to_string(member.order) + ": " + error.message;
    out.table.models.push_back(row);
  };
  if (!model) return failed(ModelState::not_identified, model.error());
  row.norm = model->predictor_norm;
  const DiscreteModel discrete{model->a, model->b, model->c};
  const auto outputs = simulated(discrete, data);
  if (!outputs) return failed(ModelState::not_validated, outputs.error());
  const auto accuracy = candidates::overall_accuracy(
      data.measured, *outputs, Eigen::RowVectorXd::Ones(data.measured.cols()), data.weights);
  if (!accuracy) return failed(ModelState::not_validated, accuracy.error());
  row.agreement = accuracy->agreement;
  row.rms = accuracy->rms;
  row.theil = accuracy->theil;
  out.models.back() = discrete;
  out.table.models.push_back(row);
}

std::vector<SpreadScore> spread_of(const RecordCandidates& all, const candidates::Selected& selected,
                                   const ValidationData& data) {
  if (selected.candidates.empty()) return {};
  const Eigen::MatrixXd& y = data.measured;
  const auto best = simulated(all.models[selected.all.front()], data);
  std::vector<Eigen::MatrixXd> series;
  for (const std::size_t i : selected.candidates) {
    if (const auto one = simulated(all.models[i], data)) series.push_back(*one);
  }
  if (!best || series.empty()) return {};
  Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(y.rows(), y.cols()), square = mean;
  for (const Eigen::MatrixXd& one : series) mean += one / static_cast<double>(series.size());
  for (const Eigen::MatrixXd& one : series) square += (one - mean).cwiseAbs2();
  const double freedom = std::max<double>(1.0, static_cast<double>(series.size()) - 1.0);
  const Eigen::MatrixXd deviation = (square / freedom).cwiseSqrt();
  std::vector<SpreadScore> out;
  for (Eigen::Index i = 0; i < y.cols(); ++i) {
    std::vector<double> accounted;
    for (const Eigen::MatrixXd& one : series)
      accounted.push_back(variance_accounted_for(y.col(i), one.col(i)));
    const Eigen::ArrayXd error = (y.col(i) - mean.col(i)).array().abs();
    SpreadScore score;
    score.output = all.outputs[static_cast<std::size_t>(i)];
    score.best_variance_accounted_for = variance_accounted_for(y.col(i), best->col(i));
    score.median_variance_accounted_for = EmpiricalCdf(accounted).quantile(0.5);
    score.error_rms = std::sqrt(error.square().mean());
    score.spread_rms = std::sqrt(deviation.col(i).squaredNorm() / static_cast<double>(y.rows()));
    score.covered = 100.0 * (error <= kCovering * deviation.col(i).array()).cast<double>().mean();
    out.push_back(std::move(score));
  }
  return out;
}

OrderCandidates order_candidates(const CandidateArguments& arguments, const RecordCandidates& all, int order,
                                 const ValidationData& data) {
  candidates::Selection selection;
  selection.order = order;
  selection.norm = arguments.norm;
  selection.smallest_norms = arguments.norm > 0.0 ? 0.0 : arguments.smallest_norms;
  selection.share = arguments.share;
  OrderCandidates out;
  out.order = order;
  out.selected = candidates::select(all.table, selection);
  for (const ModelRow& model : all.table.models) {
    if (model.order != order) continue;
    ++out.models;
    if (model.state != ModelState::ok) ++out.failed;
  }
  for (const std::size_t i : out.selected.candidates) {
    const auto radius = spectral_radius(all.models[i].a);
    if (!radius || *radius >= 1.0) ++out.unstable;
  }
  out.outputs = spread_of(all, out.selected, data);
  return out;
}

}  // namespace

Result<RecordCandidates> record_candidates(const CandidateArguments& arguments,
                                           const std::function<void(int past)>& progress) {
  const auto maneuvers = read_maneuvers(arguments);
  if (!maneuvers) return fail(maneuvers.error());
  if (maneuvers->validation.empty()) {
    return fail(
        Error{arguments.records.front(), 0, "--hold-back",
              "candidates are selected by what they repeat: keep a share of the record, for instance 0.4, or "
              "give records by --validate"});
  }
  RecordCandidates out;
  out.inputs = maneuvers->inputs;
  out.outputs = maneuvers->outputs;
  out.rate_hz = maneuvers->rate_hz;
  const std::vector<Maneuver> data = maneuvers->data();
  ValidationData validation{maneuvers->validation_data(), {}, arguments.weights};
  validation.measured = candidates::stacked_outputs(validation.maneuvers);
  int past = 0;
  const Status status =
      identify_family(data, arguments.plan, [&](const FamilyMember& member, const Result<PbsidModel>& model) {
        if (member.past != past) progress(past = member.past);
        judge(member, model, validation, out);
      });
  if (!status) return fail(Error{arguments.records.front(), 0, "candidates", status.error().message});
  for (int order = arguments.plan.lowest_order; order <= arguments.plan.highest_order; ++order)
    out.orders.push_back(order_candidates(arguments, out, order, validation));
  return out;
}

}  // namespace fatmc::cli
