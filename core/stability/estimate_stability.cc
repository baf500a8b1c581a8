#include "core/stability/estimate_stability.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/robust/intergrid.h"

namespace fatmc {

NominalLoop nominal_loop(const SampledModel& model, const Eigen::Ref<const Eigen::MatrixXd>& controller,
                         const std::vector<double>& frequency_hz, double rate_hz) {
  NominalLoop out;
  out.controller = controller.cast<std::complex<double>>();
  out.response.resize(static_cast<int>(model.c.rows()), static_cast<int>(model.b.cols()),
                      static_cast<int>(frequency_hz.size()));
  for (int k = 0; k < out.response.count(); ++k) {
    out.response[k] = sampled_response(model, frequency_hz[static_cast<std::size_t>(k)], rate_hz);
  }
  return out;
}

double smallest_input_snr_db(const FrmEstimate& estimate, int k) {
  const double snr = estimate.input_snr[k].minCoeff();
  if (!(snr > 0.0)) return -kSnrLimitDb;  // the input is below its noise, or not a number
  return std::clamp(20.0 * std::log10(snr), -kSnrLimitDb, kSnrLimitDb);
}

EstimatedLine estimated_line(const FrmEstimate& estimate, const MatrixStack<double>& bias, int k) {
  EstimatedLine line;
  line.response = estimate.G[k];
  line.sigma.resize(estimate.n_out, estimate.n_in);
  for (int j = 0; j < estimate.n_in; ++j) {
    for (int i = 0; i < estimate.n_out; ++i) line.sigma(i, j) = std::sqrt(estimate.variance(k, i, j));
  }
  line.bias = bias[k];
  line.degrees_of_freedom = estimate.q;
  line.input_snr_db = smallest_input_snr_db(estimate, k);
  return line;
}

EstimateStability judge_estimate(const FrmEstimate& estimate, const MatrixStack<double>& bias, const NominalLoop& nominal,
                                 const StabilityOptions& options, EstimateScalings* scalings) {
  const int count = estimate.line_count();
  const auto size = static_cast<std::size_t>(count);
  FATMC_CHECK(bias.count() == count && nominal.response.count() == count, "a bias and a nominal response for every line");
  EstimateStability out;
  out.lines.reserve(size);
  out.snr_min_db.reserve(size);
  if (scalings != nullptr && scalings->size() != size) scalings->assign(size, {});  // empty: cold
  for (int k = 0; k < count; ++k) {
    const auto at = static_cast<std::size_t>(k);
    out.snr_min_db.push_back(smallest_input_snr_db(estimate, k));
    if (estimate.status[at] != LineStatus::ok) {
      out.lines.push_back(failed_line(JudgementStatus::no_estimate));
      continue;
    }
    out.lines.push_back(judge_line(estimated_line(estimate, bias, k), nominal.response[k], nominal.controller, options,
                                   scalings != nullptr ? &(*scalings)[at] : nullptr));
  }
  out.band = combine_lines(out.lines);
  return out;
}

std::optional<IntergridCover> intergrid_cover(const std::vector<double>& frequency_hz, double intergrid) {
  std::optional<IntergridCover> widest;
  for (std::size_t k = 1; k < frequency_hz.size(); ++k) {
    const double spacing = frequency_hz[k] - frequency_hz[k - 1];
    const double middle = 0.5 * (frequency_hz[k] + frequency_hz[k - 1]);
    const double damping = covered_damping(spacing / middle, intergrid);
    if (!widest || damping > widest->damping) widest = IntergridCover{damping, middle, spacing};
  }
  return widest;
}

}  // namespace fatmc
