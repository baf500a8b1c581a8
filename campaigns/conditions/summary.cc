#include "campaigns/conditions/summary.h"

#include <algorithm>

#include "campaigns/base/verdict.h"
#include "campaigns/conditions/condition_runs.h"

namespace fatmc::conditions {
namespace {

/// The table's name: A.6 where the turn coordinator is what varies.
std::string table_of(const std::vector<ConditionRuns>& cells) {
  for (const ConditionRuns& cell : cells) {
    if (cell.condition.turn_coordinator != cells.front().condition.turn_coordinator) return "Section A.6";
  }
  return "Conditions";
}

TableRow cell_row(const ConditionRuns& cell, const std::string& quantity, const std::string& unit) {
  TableRow row = table_row("", cell.name, quantity, unit);
  if (cell.failed > 0)
    row.why =
        std::to_string(cell.failed) + " of " + std::to_string(cell.trials) + " flights gave no estimate";
  return row;
}

void add_mean(const ConditionRuns& cell, const std::string& quantity, const std::string& unit,
              const std::vector<double>& values, double factor, std::vector<TableRow>& out) {
  TableRow row = cell_row(cell, quantity, unit);
  fill_mean(row, values, kPublishedRepetitions, factor);
  if (unit == "%") {
    row.low = std::max(row.low, 0.0);
    if (quantity.starts_with("share") || quantity.starts_with("time")) row.high = std::min(row.high, 100.0);
  }
  out.push_back(std::move(row));
}

}  // namespace

Result<std::vector<TableRow>> tables(const CampaignSpec& spec, const RowSource& rows) {
  const auto cells = collect(spec, rows);
  if (!cells) return fail(cells.error());
  std::vector<TableRow> out;
  for (const ConditionRuns& cell : *cells) {
    if (cell.trials == 0) continue;
    TableRow lost = cell_row(cell, "flights that gave no estimate", "%");
    fill_share(lost, cell.failed, cell.trials, kPublishedRepetitions);
    lost.why = cell.failed > 0 ? "the first of them: " + cell.failure : "";
    out.push_back(std::move(lost));
    if (cell.trials == cell.failed) continue;
    for (std::size_t e = 0; e < kElements.size(); ++e) {
      add_mean(cell, "rms of |error|/|G0|, " + std::string(kElements[e].label), "%", cell.relative_error[e],
               100.0, out);
    }
    add_mean(cell, "share of 95 % regions that hold G0", "%", cell.inside_95, 100.0, out);
    for (std::size_t j = 0; j < 3; ++j) {
      static constexpr std::array kInputs = {"ξ_c", "η_c", "ζ_c"};
      add_mean(cell, std::string("median input SNR, ") + kInputs[j], "dB", cell.median_snr_db[j], 1.0, out);
    }
    add_mean(cell, "share of lines and inputs below 3 standard deviations", "%", cell.outliers, 100.0, out);
    add_mean(cell, "time that a servo stands at its rate limit", "%", cell.at_rate_limit, 100.0, out);
  }
  const std::string table = table_of(*cells);
  for (TableRow& row : out) row.table = table;
  return out;
}

const SummaryStudy kSummaryStudy{"conditions", &tables, &figures};

}  // namespace fatmc::conditions
