#include "core/discrepancy/gap_measures.h"

#include <span>

#include "core/accuracy/response_accuracy.h"
#include "core/accuracy/series_accuracy.h"
#include "core/discrepancy/response_map.h"

namespace fatmc {

Result<MeanFlight> mean_flight(const ModelSimulator& model, const LpmGrid& grid,
                               const std::vector<Effect>& effects, int first, int count) {
  MeanFlight out;
  out.response.setZero(9 * grid.line_count());
  out.output.setZero(model.reference().rows(), 3);
  FastLpm estimator(grid, 3);
  for (int n = first; n < first + count; ++n) {
    auto record = model.record(effects, n);
    if (!record) return fail(record.error());
    out.response += response_vector(estimator, *record, model.setup().closed_loop) / count;
    out.output += record->output / count;
  }
  return out;
}

GapMeasures measure_gap(const std::vector<double>& frequency_hz,
                        const Eigen::Ref<const Eigen::VectorXcd>& response,
                        const Eigen::Ref<const Eigen::MatrixX3d>& output, const MeanFlight& model) {
  GapMeasures out;
  double lines = 0.0, outside = 0.0;
  std::vector<double> agreements;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<ResponseError> errors;
    for (std::size_t k = 0; k < frequency_hz.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(9 * k) + 4 * axis;
      const auto error = response_error(response[at], model.response[at]);
      if (!error) continue;
      errors.push_back(*error);
      lines += 1.0;
      outside += unnoticed(*error, frequency_hz[k]) ? 0.0 : 1.0;
    }
    if (!errors.empty()) out.cost += response_cost(errors) / 3.0;
    const auto n = static_cast<std::size_t>(output.rows());
    const Eigen::VectorXd measured = output.col(axis), simulated = model.output.col(axis);
    const std::span<const double> y(measured.data(), n), m(simulated.data(), n);
    out.theil += theil_coefficient(y, m).value_or(0.0) / 3.0;
    agreements.push_back(index_of_agreement(y, m).value_or(1.0));
  }
  out.muad_share = lines > 0.0 ? outside / lines : 0.0;
  out.agreement = overall_index_of_agreement(agreements);
  return out;
}

}  // namespace fatmc
