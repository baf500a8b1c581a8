#include "campaigns/candidates/maneuver_validation.h"

#include <algorithm>
#include <cmath>

#include "core/accuracy/series_accuracy.h"
#include "core/subspace/model_fit.h"

namespace fatmc::candidates {
namespace {

Eigen::Index sample_count(std::span<const Maneuver> maneuvers) {
  Eigen::Index out = 0;
  for (const Maneuver& maneuver : maneuvers) out += maneuver.samples();
  return out;
}

std::span<const double> column(const Eigen::MatrixXd& matrix, Eigen::Index i) {
  return {matrix.col(i).data(), static_cast<std::size_t>(matrix.rows())};
}

}  // namespace

Eigen::MatrixXd stacked_outputs(std::span<const Maneuver> maneuvers) {
  Eigen::MatrixXd out(sample_count(maneuvers), maneuvers.front().outputs.cols());
  Eigen::Index row = 0;
  for (const Maneuver& maneuver : maneuvers) {
    out.middleRows(row, maneuver.samples()) = maneuver.outputs;
    row += maneuver.samples();
  }
  return out;
}

Result<Eigen::MatrixXd> repeated_outputs(const ModalModel& modal, std::span<const Maneuver> maneuvers) {
  Eigen::MatrixXd out(sample_count(maneuvers), modal.model.c.rows());
  Eigen::Index row = 0;
  for (const Maneuver& maneuver : maneuvers) {
    const auto fit = fit_maneuver(modal, maneuver);
    if (!fit) return fail(fit.error());
    out.middleRows(row, maneuver.samples()) = fit->outputs;
    row += maneuver.samples();
  }
  return out;
}

Result<OverallAccuracy> overall_accuracy(const Eigen::MatrixXd& measured, const Eigen::MatrixXd& simulated,
                                         const Eigen::RowVectorXd& units, std::span<const double> weights) {
  OverallAccuracy out;
  const Eigen::MatrixXd m = measured * units.asDiagonal(), y = simulated * units.asDiagonal();
  out.rms = rms_error(m, y);
  if (!std::isfinite(out.rms)) return fail("the simulated maneuvers run away: the model is unstable");
  for (Eigen::Index i = 0; i < measured.cols(); ++i) {
    const auto index = index_of_agreement(column(measured, i), column(simulated, i));
    if (!index) return fail("an output of the validation maneuvers never moves");
    out.output_agreement.push_back(std::max(0.0, *index));  // rounding
  }
  out.agreement = overall_index_of_agreement(out.output_agreement, weights);
  const auto count = static_cast<std::size_t>(m.size());
  out.theil = theil_coefficient({m.data(), count}, {y.data(), count}).value_or(0.0);
  return out;
}

}  // namespace fatmc::candidates
