#include "campaigns/hidden_effect/summary.h"

#include <optional>

#include "campaigns/base/verdict.h"
#include "campaigns/hidden_effect/bars.h"
#include "campaigns/hidden_effect/figures.h"
#include "campaigns/hidden_effect/hidden_results.h"
#include "core/stats/empirical.h"
#include "core/stats/intervals.h"
#include "core/stats/quantile_interval.h"

namespace fatmc::hidden_effect {
namespace {

constexpr const char* kTable = "Hidden effects";
constexpr const char* kEffectTable = "Hidden effects, one by one";

/// Rows of one cell; intervals are those of the quantity itself (95 %), not of a repetition.
class CellTable {
 public:
  CellTable(const CellResults& cell, std::vector<TableRow>& out) : cell_(cell), out_(out) {}

  void share(const std::string& quantity, const Count& count, std::optional<Quantity> judged = {},
             const char* table = kTable) {
    if (count.n == 0) return;
    TableRow row = table_row(table, cell_.name, quantity, "%");
    const Interval interval = proportion_interval(count.hits, count.n);
    row.value = 100.0 * static_cast<double>(count.hits) / static_cast<double>(count.n);
    row.low = 100.0 * interval.low;
    row.high = 100.0 * interval.high;
    row.n = count.n;
    finish(std::move(row), judged);
  }
  /// In %.
  void quantile(const std::string& quantity, const std::vector<double>& values, double p,
                std::optional<Quantity> judged, const char* table = kTable) {
    if (values.empty()) return;
    TableRow row = table_row(table, cell_.name, quantity, "%");
    const EmpiricalCdf cdf(values);
    const Interval interval = quantile_interval(cdf.sorted(), p);
    row.value = 100.0 * cdf.quantile(p);
    row.low = 100.0 * interval.low;
    row.high = 100.0 * interval.high;
    row.n = values.size();
    finish(std::move(row), judged);
  }
  void mean(const std::string& quantity, const std::vector<double>& values, Quantity judged) {
    if (values.size() < 2) return;
    TableRow row = table_row(kTable, cell_.name, quantity, "");
    const RunMean runs = mean_over_runs(values);
    const Interval interval = mean_interval(runs);
    row.value = runs.mean;
    row.low = interval.low;
    row.high = interval.high;
    row.n = runs.n;
    finish(std::move(row), judged);
  }
  /// The one-sided upper 95 % bound of a share, itself the value.
  void bound(const std::string& quantity, const Count& count, Quantity judged) {
    TableRow row = table_row(kTable, cell_.name, quantity, "%");
    row.value = 100.0 * proportion_interval(count.hits, count.n, 0.90).high;
    row.n = count.n;
    finish(std::move(row), judged);
  }

 private:
  void finish(TableRow row, std::optional<Quantity> judged) {
    if (judged) judge_by_bar(row, bar_of(cell_.tier.role, *judged));
    out_.push_back(std::move(row));
  }
  const CellResults& cell_;
  std::vector<TableRow>& out_;
};

void write_null(const CellResults& r, CellTable& table) {
  table.share("false alarm", r.detected, Quantity::false_alarm);
  table.bound("false alarm, one-sided upper 95 % bound", r.detected, Quantity::false_alarm_bound);
}

void write_names(const CellResults& r, CellTable& table) {
  table.share("detected", r.detected, Quantity::detected);
  if (r.tier.draw.effects == 2) {
    table.share("both named", r.both, Quantity::both);
    table.share("at least one named", r.any, Quantity::any);
  } else {
    table.share("right name", r.right, Quantity::right);
    table.share("right name if detected", r.right_if_detected, Quantity::right_if_detected);
    table.share("named or in the class, of answers with a name", r.class_holds, Quantity::class_holds);
    table.mean("mean class size", r.class_size, Quantity::class_size);
  }
  table.share("confident wrong name", r.wrong, Quantity::wrong);
  table.share("spurious further effect", r.spurious, Quantity::spurious);
}

void write_sizes(const CellResults& r, CellTable& table) {
  table.quantile("parameter error, median", r.parameter_error, 0.5, Quantity::error_median);
  table.quantile("parameter error, 90 % quantile", r.parameter_error, 0.9, Quantity::error_high);
  table.share("95 % interval covers", r.covered, Quantity::covered);
  table.quantile("gap left on an unseen record, median", r.gap_left, 0.5, Quantity::gap_median);
  table.quantile("gap left on an unseen record, 90 % quantile", r.gap_left, 0.9, Quantity::gap_high);
}

void write_effects(const CellResults& r, CellTable& table) {
  const bool known = r.tier.role != Role::unknown;
  for (const auto& [number, one] : r.by_effect) {
    const std::string name = effect_name(number) + ": ";
    if (!known) {
      table.share(name + "unknown", one.unknown, std::nullopt, kEffectTable);
      continue;
    }
    table.share(name + "right name", one.right, Quantity::right_one_effect, kEffectTable);
    table.share(name + "detected", one.detected, std::nullopt, kEffectTable);
    table.quantile(name + "parameter error, median", one.error, 0.5, std::nullopt, kEffectTable);
    table.share(name + "95 % interval covers", one.covered, std::nullopt, kEffectTable);
  }
  for (const auto& [pair, n] : r.confusion) {
    if (pair.first == pair.second) continue;
    table.share(effect_name(pair.first) + ": answered " + effect_name(pair.second),
                {n, r.by_effect.at(pair.first).right.n}, std::nullopt, kEffectTable);
  }
}

void write_cell(const CellResults& r, std::vector<TableRow>& out) {
  CellTable table(r, out);
  table.share("no answer", r.failed);
  if (r.tier.draw.effects == 0) return write_null(r, table);
  if (r.tier.role == Role::unknown) {
    table.share("detected", r.detected);
    table.share("unknown flagged", r.unknown, Quantity::unknown);
    table.share("unknown flagged, absorbable ones", r.unknown_absorbable, Quantity::unknown_absorbable);
    table.share("confident wrong name", r.wrong);
  } else {
    write_names(r, table);
    table.share("known flagged as unknown", r.unknown, Quantity::unknown);
    write_sizes(r, table);
  }
}

Result<std::vector<TableRow>> tables(const CampaignSpec& spec, const RowSource& rows) {
  auto cells = read_results(spec, rows);
  if (!cells) return fail(cells.error());
  std::vector<TableRow> out;
  for (const CellResults& cell : *cells) {
    if (cell.trials() > 0) write_cell(cell, out);
  }
  for (const CellResults& cell : *cells) {
    CellTable table(cell, out);
    write_effects(cell, table);
  }
  return out;
}

}  // namespace

const SummaryStudy kSummaryStudy{"hidden_effect", &tables, &figures};

}  // namespace fatmc::hidden_effect
