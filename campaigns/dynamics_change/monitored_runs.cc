#include "campaigns/dynamics_change/monitored_runs.h"

#include "campaigns/dynamics_change/row_arrays.h"
#include "core/base/check.h"

namespace fatmc::dynamics_change {
namespace {

double metric(const TrialRow& row, std::string_view name) {
  for (const auto& [key, value] : row.metrics) {
    if (key == name) return value;
  }
  FATMC_CHECK(false, "a row of a flight holds all its metrics");
}

std::vector<double> array(const TrialRow& row, std::string_view name) {
  const std::vector<double>* values = row.array(name);
  FATMC_CHECK(values != nullptr, "a row of a flight holds all its arrays");
  return *values;
}

}  // namespace

MonitoredCell read_cell(std::uint32_t cell, const RowSource& rows) {
  MonitoredCell out;
  rows(cell, [&](const TrialRow& row) {
    if (row.array(kCslSsv) == nullptr) {
      ++out.without_flight;
      return;
    }
    MonitoredRun run{.epoch_s = metric(row, kEpoch),
                     .window_s = metric(row, kWindow),
                     .onset_s = metric(row, kOnset),
                     .duration_s = metric(row, kDuration),
                     .strength = metric(row, kStrength),
                     .flown_s = metric(row, kFlown),
                     .diverged = row.outcome == "diverged",
                     .csl = array(row, kCslSsv),
                     .robust = array(row, kRobustSsv),
                     .noise = {array(row, kNoise[0]), array(row, kNoise[1]), array(row, kNoise[2])}};
    out.runs.push_back(std::move(run));
  });
  return out;
}

}  // namespace fatmc::dynamics_change
