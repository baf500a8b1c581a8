#include "campaigns/estimators/cell_runs.h"

#include <algorithm>
#include <cmath>

#include "campaigns/base/decoder.h"

namespace fatmc::estimators {
namespace {

// The cost of a run with an estimate of zero is missing.
std::optional<double> metric_if_any(const TrialRow& row, const std::string& name) {
  for (const auto& [key, value] : row.metrics) {
    if (key == name) return value;
  }
  return std::nullopt;
}

void add_run(const TrialRow& row, CellRuns& out) {
  out.frequency_hz = array_of(row, kFrequency);
  for (std::size_t e = 0; e < kEstimators.size(); ++e) {
    const Estimator& estimator = kEstimators[e];
    EstimatorRuns& runs = out.of[e];
    const auto& re = array_of(row, name_of(estimator, kErrorReal));
    const auto& im = array_of(row, name_of(estimator, kErrorImag));
    std::vector<std::complex<double>> error;
    for (std::size_t k = 0; k < re.size(); ++k) error.emplace_back(re[k], im[k]);
    runs.error.push_back(std::move(error));
    runs.inside_90.push_back(metric_of(row, name_of(estimator, kInside90)));
    runs.unnoticed.push_back(metric_of(row, name_of(estimator, kUnnoticed)));
    runs.relative_error.push_back(metric_of(row, name_of(estimator, kRelativeError)));
    if (const auto value = metric_if_any(row, name_of(estimator, kCost))) runs.cost.push_back(*value);
  }
}

}  // namespace

double EstimatorRuns::magnitude_error(std::size_t run, std::size_t line) const {
  return std::abs(1.0 + error[run][line]) - 1.0;
}

double EstimatorRuns::magnitude_error_db(std::size_t run, std::size_t line) const {
  return 20.0 * std::log10(std::abs(1.0 + error[run][line]));
}

std::vector<double> EstimatorRuns::magnitude_errors(std::size_t line) const {
  std::vector<double> out;
  for (std::size_t run = 0; run < error.size(); ++run) out.push_back(magnitude_error(run, line));
  return out;
}

std::vector<double> EstimatorRuns::magnitude_errors_db(std::size_t line) const {
  std::vector<double> out;
  for (std::size_t run = 0; run < error.size(); ++run) out.push_back(magnitude_error_db(run, line));
  return out;
}

bool CellRuns::shown_in(std::string_view what) const {
  return std::find(shows.begin(), shows.end(), what) != shows.end();
}

std::string CellRuns::row_name(std::size_t estimator) const {
  const std::string label(kEstimators[estimator].label);
  return name.empty() ? label : label + ", " + name;
}

std::string CellRuns::failures() const {
  return failed > 0 ? std::to_string(failed) + " trials without an estimate" : "";
}

Result<CellRuns> collect_cell(const CampaignSpec& spec, std::uint32_t index, const RowSource& rows) {
  CellRuns cell;
  Decoder table(spec.cells.at(index).tree, "cell");
  cell.name = table.text("label", spec.cells[index].name);
  if (table.has("shows")) cell.shows = table.texts("shows");
  if (table.error()) return fail(*table.error());
  rows(index, [&](const TrialRow& row) {
    ++cell.trials;
    if (row.outcome == "ok") return add_run(row, cell);
    ++cell.failed;
  });
  // A trial without an estimate has no region and no error inside any limit.
  for (EstimatorRuns& runs : cell.of) {
    runs.inside_90.resize(cell.trials, 0.0);
    runs.unnoticed.resize(cell.trials, 0.0);
  }
  return cell;
}

}  // namespace fatmc::estimators
