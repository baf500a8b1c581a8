#include "campaigns/bias/error_runs.h"

#include <cmath>
#include <numbers>

namespace fatmc::bias {

ErrorRuns error_runs(std::uint32_t cell, const RowSource& rows) {
  ErrorRuns out;
  rows(cell, [&](const TrialRow& row) {
    ++out.trials;
    if (row.outcome != "ok") {
      ++out.failed;
      return;
    }
    if (out.frequency_hz.empty()) out.frequency_hz = array_of(row, kFrequency);
    for (std::size_t r = 0; r < kResponses.size(); ++r) {
      const auto& re = array_of(row, ratio_re(kResponses[r]));
      const auto& im = array_of(row, ratio_im(kResponses[r]));
      std::vector<std::complex<double>> ratio;
      for (std::size_t k = 0; k < re.size(); ++k) ratio.emplace_back(re[k], im[k]);
      out.ratio[r].push_back(std::move(ratio));
      for (std::size_t i = 0; i < kReadings.size(); ++i)
        out.relative_bias[r][i].push_back(metric_of(row, relative_bias(kResponses[r], kReadings[i])));
    }
  });
  return out;
}

std::complex<double> mean_ratio(const ErrorRuns& runs, std::size_t response, std::size_t line,
                                std::span<const std::size_t> picks) {
  std::complex<double> sum;
  for (const std::size_t run : picks) sum += runs.ratio[response][run][line];
  return sum / static_cast<double>(picks.size());
}

MeanError mean_error(const ErrorRuns& runs, std::size_t response, std::span<const std::size_t> picks) {
  std::vector<std::complex<double>> sum(runs.frequency_hz.size());
  for (const std::size_t run : picks) {
    const auto& ratio = runs.ratio[response][run];
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += ratio[k];
  }
  MeanError out;
  for (const std::complex<double> total : sum) {
    const std::complex<double> mean = total / static_cast<double>(picks.size());
    out.magnitude_db.push_back(magnitude_error_db(mean));
    out.phase_deg.push_back(phase_error_deg(mean));
  }
  return out;
}

double magnitude_error_db(std::complex<double> ratio) { return 20.0 * std::log10(std::abs(ratio)); }
double phase_error_deg(std::complex<double> ratio) { return std::arg(ratio) * 180.0 / std::numbers::pi; }

}  // namespace fatmc::bias
