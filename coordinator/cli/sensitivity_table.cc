#include "coordinator/cli/sensitivity_table.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "coordinator/cli/trial_name.h"
#include "core/base/text.h"

namespace fatmc::cli {
namespace {

constexpr std::string_view kFailed = "failed";

// The trials of a cell as columns: parameters and metrics by name, NaN where a trial has none.
struct Columns {
  std::size_t trials = 0;
  std::vector<std::string> order;  // of the metrics, as rows give them
  std::map<std::string, std::vector<double>> drawn, metrics;
};

void put(std::map<std::string, std::vector<double>>& columns, const std::string& name, std::size_t trial,
         double value) {
  auto& column = columns[name];
  column.resize(trial, std::nan(""));
  column.push_back(value);
}

Columns read_columns_of(const CampaignReader& reader, std::uint32_t cell) {
  Columns out;
  reader.visit(cell,
               [&](const TrialRow& row) {
                 for (const auto& [name, value] : row.metrics) {
                   const bool drawn = name.starts_with(kDrawPrefix);
                   if (!drawn && !out.metrics.contains(name)) out.order.push_back(name);
                   put(drawn ? out.drawn : out.metrics, drawn ? name.substr(kDrawPrefix.size()) : name,
                       out.trials, value);
                 }
                 put(out.metrics, std::string(kFailed), out.trials, row.outcome == "ok" ? 0.0 : 1.0);
                 ++out.trials;
               },
               {.arrays = false});
  out.order.emplace_back(kFailed);
  for (auto* columns : {&out.drawn, &out.metrics}) {
    for (auto& [name, column] : *columns) column.resize(out.trials, std::nan(""));
  }
  return out;
}

std::optional<SensitivityRow> compare(const std::vector<double>& x, const std::vector<double>& y,
                                      const SensitivityRequest& request) {
  std::vector<double> a, b;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
    a.push_back(x[i]);
    b.push_back(y[i]);
  }
  SensitivityRow row;
  row.n = a.size();
  row.rank = rank_correlation(a, b, request.level);
  if (!row.rank) return std::nullopt;
  row.share = first_order_share(a, b, {.level = request.level, .resamples = request.resamples});
  return row;
}

void add_metric(const Columns& columns, const std::string& cell, const std::string& metric,
                const SensitivityRequest& request, std::vector<SensitivityRow>& out) {
  std::vector<SensitivityRow> rows;
  for (const auto& [parameter, values] : columns.drawn) {
    auto row = compare(values, columns.metrics.at(metric), request);
    if (!row) continue;
    row->cell = cell;
    row->metric = metric;
    row->parameter = parameter;
    rows.push_back(std::move(*row));
  }
  std::stable_sort(rows.begin(), rows.end(), [](const SensitivityRow& a, const SensitivityRow& b) {
    const auto strength = [](const SensitivityRow& r) {
      return r.share ? r.share->value : std::abs(r.rank->value);
    };
    return strength(a) > strength(b);
  });
  out.insert(out.end(), rows.begin(), rows.end());
}

}  // namespace

Result<std::vector<SensitivityRow>> sensitivity(const CampaignReader& reader,
                                                const SensitivityRequest& request) {
  const CampaignSpec& spec = reader.spec();
  if (spec.dispersions.empty()) {
    return fail(
        Error{"", 0, "sensitivity", "nothing is drawn in this campaign: its spec has no [[dispersion]]"});
  }
  std::uint32_t first = 0, last = static_cast<std::uint32_t>(spec.cells.size());
  if (!request.cell.empty()) {
    const Result<std::uint32_t> cell = find_cell(spec, request.cell, "--cell");
    if (!cell) return fail(cell.error());
    first = *cell;
    last = first + 1;
  }
  std::vector<SensitivityRow> out;
  std::set<std::string> known;
  for (std::uint32_t cell = first; cell < last; ++cell) {
    const Columns columns = read_columns_of(reader, cell);
    known.insert(columns.order.begin(), columns.order.end());
    for (const std::string& metric : columns.order) {
      if (!columns.metrics.contains(metric) || (!request.metric.empty() && metric != request.metric))
        continue;
      add_metric(columns, spec.cells[cell].name, metric, request, out);
    }
  }
  if (!request.metric.empty() && !known.contains(request.metric)) {
    return fail(Error{"", 0, "--metric",
                      "no metric \"" + request.metric + "\" in these rows, write one of: " +
                          join(std::vector<std::string>(known.begin(), known.end()))});
  }
  return out;
}

}  // namespace fatmc::cli
