#include "coordinator/cli/turbulence_level.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fatmc::cli {
namespace {

constexpr int kFlights = 4;
constexpr double kHighest_hz = 2.5, kFirst = 0.5, kLeast = 1e-3;

/// Median over the noise features of record minus model: twice the log of the ratio of levels.
Result<double> median_difference(const ModelSimulator& model, const Eigen::VectorXd& features, int threads) {
  const std::vector<std::vector<Effect>> sets = {{}};
  const EffectFlights flown = model.fly(sets, 0, kFlights, threads).front();
  if (!flown.usable()) return fail("the model does not survive the record's reference: " + flown.failure);
  const Eigen::VectorXd difference = features - flown.features.rowwise().mean();
  std::vector<double> values;
  for (const FeatureBlock& block : model.extractor().layout().blocks) {
    if (block.kind != FeatureKind::noise || block.high_hz > kHighest_hz) continue;
    for (int c = 0; c < 3; ++c) values.push_back(difference[block.first + c]);
  }
  if (values.empty())
    return fail("has no band of noise to estimate the turbulence from: state it in [environment]");
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

}  // namespace

Result<double> estimate_turbulence(
    const FlightSetup& setup, const Eigen::VectorXd& features,
    const std::function<std::unique_ptr<ModelSimulator>(const FlightSetup&)>& simulator, int threads) {
  FlightSetup at = setup;
  double log_level = std::log(kFirst);
  // Powers go with the square of the level: each round halves the difference away, but for what the gyros add.
  for (int round = 0; round < 6; ++round) {
    at.turbulence_m_s = std::exp(log_level);
    auto difference = median_difference(*simulator(at), features, threads);
    if (!difference) return fail(difference.error());
    const double step = std::clamp(0.5 * *difference, -2.0, 1.5);
    log_level += step;
    if (log_level < std::log(kLeast)) return 0.0;
    if (std::abs(step) < 0.01) break;
  }
  constexpr double kStep = 0.04332169878499658;  // ln 2 / 16
  return std::exp(kStep * std::round(log_level / kStep));
}

}  // namespace fatmc::cli
