#include "campaigns/conditions/condition_runs.h"

#include <algorithm>
#include <cmath>

#include "campaigns/base/prepared_trials.h"
#include "campaigns/base/spec_path.h"

namespace fatmc::conditions {
namespace {

/// A value of the cell's own table, or else of its experiment.
const Tree* value_of(const CampaignSpec& cell, const char* own, const char* path) {
  const Tree* value = cell.cells.front().tree.find(own);
  return value != nullptr ? value : find_at(cell.tree, path);
}

Condition condition_of(const CampaignSpec& cell) {
  Condition out;
  if (const Tree* sigma =
          value_of(cell, "turbulence_sigma_m_s", "experiment.environment.turbulence_sigma_m_s"))
    out.turbulence_m_s = real_value(*sigma).value_or(0.0);
  if (const Tree* gain = find_at(cell.tree, "experiment.controller.gain.1"))
    out.gain = real_value(*gain).value_or(0.0);
  if (const Tree* grade = find_at(cell.tree, "experiment.imu.grade")) {
    if (const auto* text = std::get_if<std::string>(&grade->value)) out.grade = *text;
  }
  if (const Tree* on = value_of(cell, "turn_coordinator", "experiment.controller.turn_coordinator")) {
    if (const auto* value = std::get_if<bool>(&on->value)) out.turn_coordinator = *value;
  }
  return out;
}

/// Sums over runs, in their order.
struct LineSums {
  std::vector<std::complex<double>> sum;
  std::vector<double> square;
  void add(const std::vector<double>& re, const std::vector<double>& im) {
    sum.resize(re.size());
    square.resize(re.size());
    for (std::size_t k = 0; k < re.size(); ++k) {
      sum[k] += std::complex<double>(re[k], im[k]);
      square[k] += re[k] * re[k] + im[k] * im[k];
    }
  }
};

void add_run(const TrialRow& row, ConditionRuns& out, std::array<LineSums, kElements.size()>& sums) {
  out.frequency_hz = array_of(row, kFrequency);
  for (std::size_t e = 0; e < kElements.size(); ++e) {
    out.relative_error[e].push_back(metric_of(row, name_of(kElements[e], kRelativeError)));
    sums[e].add(array_of(row, name_of(kElements[e], kErrorReal)),
                array_of(row, name_of(kElements[e], kErrorImag)));
  }
  for (std::size_t j = 0; j < kMedianSnr.size(); ++j)
    out.median_snr_db[j].push_back(metric_of(row, kMedianSnr[j]));
  out.outliers.push_back(metric_of(row, kOutliers));
  out.inside_95.push_back(metric_of(row, kInside95));
  double limited = 0.0;
  for (const char* servo : {"aileron", "left_ruddervator", "right_ruddervator"})
    limited = std::max(limited, metric_of(row, std::string("share_at_rate_limit_") + servo));
  out.at_rate_limit.push_back(limited);
}

void finish(const std::array<LineSums, kElements.size()>& sums, ConditionRuns& out) {
  const auto n = static_cast<double>(out.trials - out.failed);
  for (std::size_t e = 0; e < kElements.size(); ++e) {
    for (std::size_t k = 0; k < sums[e].sum.size(); ++k) {
      const std::complex<double> mean = sums[e].sum[k] / n;
      out.mean_error[e].push_back(mean);
      const double spread = std::max(0.0, sums[e].square[k] / n - std::norm(mean));
      out.deviation[e].push_back(n > 1.0 ? std::sqrt(spread * n / (n - 1.0)) : 0.0);
    }
  }
  out.inside_95.resize(out.trials, 0.0);
}

}  // namespace

Result<std::vector<ConditionRuns>> collect(const CampaignSpec& spec, const RowSource& rows) {
  std::vector<ConditionRuns> out;
  for (std::uint32_t index = 0; index < spec.cells.size(); ++index) {
    const auto cell = spec_of_cell(spec, index);
    if (!cell) return fail(cell.error());
    ConditionRuns runs;
    runs.name = spec.cells[index].name;
    runs.condition = condition_of(*cell);
    std::array<LineSums, kElements.size()> sums;
    rows(index, [&](const TrialRow& row) {
      ++runs.trials;
      if (row.outcome == "ok") return add_run(row, runs, sums);
      if (runs.failed++ == 0) runs.failure = row.outcome + ", " + row.detail;
    });
    finish(sums, runs);
    out.push_back(std::move(runs));
  }
  return out;
}

}  // namespace fatmc::conditions
