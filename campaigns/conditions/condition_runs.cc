#include "campaigns/conditions/condition_runs.h"

#include <algorithm>
#include <cmath>

#include "campaigns/base/prepared_trials.h"
#include "core/base/check.h"

namespace fatmc::conditions {
namespace {

const std::vector<double>& need(const TrialRow& row, const std::string& name) {
  const std::vector<double>* values = row.array(name);
  FATMC_CHECK(values != nullptr, "a row of the conditions study holds all its arrays");
  return *values;
}

double metric(const TrialRow& row, std::string_view name) {
  for (const auto& [key, value] : row.metrics) {
    if (key == name) return value;
  }
  FATMC_CHECK(false, "a row of the conditions study holds all its metrics");
}

const Tree* at(const Tree& tree, std::initializer_list<std::string_view> path) {
  const Tree* here = &tree;
  for (const std::string_view key : path) {
    if (here != nullptr) here = here->find(key);
  }
  return here;
}

Condition condition_of(const CampaignSpec& cell) {
  Condition out;
  const auto number = [](const Tree* tree, double fallback) {
    return tree != nullptr ? real_value(*tree).value_or(fallback) : fallback;
  };
  const Tree& own = cell.cells.front().tree;
  const Tree* sigma = own.find("turbulence_sigma_m_s");
  out.turbulence_m_s = number(
      sigma != nullptr ? sigma : at(cell.tree, {"experiment", "environment", "turbulence_sigma_m_s"}), 0.0);
  const Tree* gain = at(cell.tree, {"experiment", "controller", "gain"});
  if (gain != nullptr && gain->array() != nullptr && !gain->array()->items.empty())
    out.gain = number(&gain->array()->items.front(), 0.0);
  if (const Tree* grade = at(cell.tree, {"experiment", "imu", "grade"})) {
    if (const auto* text = std::get_if<std::string>(&grade->value)) out.grade = *text;
  }
  const Tree* coordinator = own.find("turn_coordinator");
  if (coordinator == nullptr) coordinator = at(cell.tree, {"experiment", "controller", "turn_coordinator"});
  if (coordinator != nullptr) {
    if (const auto* on = std::get_if<bool>(&coordinator->value)) out.turn_coordinator = *on;
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
  out.frequency_hz = need(row, std::string(kFrequency));
  for (std::size_t e = 0; e < kElements.size(); ++e) {
    out.relative_error[e].push_back(metric(row, name_of(kElements[e], kRelativeError)));
    sums[e].add(need(row, name_of(kElements[e], kErrorReal)), need(row, name_of(kElements[e], kErrorImag)));
  }
  for (std::size_t j = 0; j < kMedianSnr.size(); ++j)
    out.median_snr_db[j].push_back(metric(row, kMedianSnr[j]));
  out.outliers.push_back(metric(row, kOutliers));
  out.inside_95.push_back(metric(row, kInside95));
  double limited = 0.0;
  for (const char* servo : {"aileron", "left_ruddervator", "right_ruddervator"})
    limited = std::max(limited, metric(row, std::string("share_at_rate_limit_") + servo));
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
