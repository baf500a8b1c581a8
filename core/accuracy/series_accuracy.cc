#include "core/accuracy/series_accuracy.h"

#include <cmath>
#include <numeric>

#include "core/base/check.h"

namespace fatmc {

std::optional<double> theil_coefficient(std::span<const double> measured, std::span<const double> simulated) {
  FATMC_CHECK(measured.size() == simulated.size() && !measured.empty(), "two series of one length");
  double difference = 0.0, m = 0.0, y = 0.0;
  for (std::size_t k = 0; k < measured.size(); ++k) {
    difference += (measured[k] - simulated[k]) * (measured[k] - simulated[k]);
    m += measured[k] * measured[k];
    y += simulated[k] * simulated[k];
  }
  const double sum = std::sqrt(m) + std::sqrt(y);
  if (!(sum > 0.0)) return std::nullopt;
  return std::sqrt(difference) / sum;
}

std::optional<double> index_of_agreement(std::span<const double> measured,
                                         std::span<const double> simulated) {
  FATMC_CHECK(measured.size() == simulated.size() && !measured.empty(), "two series of one length");
  const double mean =
      std::accumulate(measured.begin(), measured.end(), 0.0) / static_cast<double>(measured.size());
  double difference = 0.0, potential = 0.0;
  for (std::size_t k = 0; k < measured.size(); ++k) {
    difference += std::abs(measured[k] - simulated[k]);
    potential += std::abs(measured[k] - mean) + std::abs(simulated[k] - mean);
  }
  if (!(potential > 0.0)) return std::nullopt;
  return 1.0 - difference / potential;
}

double overall_index_of_agreement(std::span<const double> indices, std::span<const double> weights) {
  FATMC_CHECK(!indices.empty(), "at least one output");
  FATMC_CHECK(weights.empty() || weights.size() == indices.size(), "a weight an output");
  const auto count = static_cast<double>(indices.size());
  double product = 1.0;
  for (std::size_t i = 0; i < indices.size(); ++i)
    product *= std::pow(indices[i], (weights.empty() ? 1.0 : weights[i]) / count);
  return product;
}

}  // namespace fatmc
