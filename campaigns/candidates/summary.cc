#include "campaigns/candidates/summary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "campaigns/base/prepared_trials.h"
#include "campaigns/base/verdict.h"
#include "campaigns/candidates/model_table.h"
#include "core/base/text.h"
#include "core/stats/empirical.h"

namespace fatmc::candidates {
namespace {

constexpr double kSpread = 1.96;  // standard deviations of an interval
constexpr const char* kOneRecord =
    "one flight test: the interval is the spread of the candidates, which H takes for the uncertainty";

/// Rows of one cell, with what print says of it.
class CellTables {
 public:
  CellTables(std::string suffix, std::vector<PublishedFigure> published, std::vector<TableRow>& out)
      : suffix_(std::move(suffix)), published_(std::move(published)), out_(out) {}

  TableRow row(const std::string& table, const std::string& name, const std::string& quantity,
               const std::string& unit, double value, std::uint64_t n) const {
    TableRow row = table_row(table, name, quantity, unit);
    row.published = published_value(published_, row);
    row.row += suffix_;
    row.value = value;
    row.n = n;
    return row;
  }

  /// The same with more behind the names of its rows.
  [[nodiscard]] CellTables with(const std::string& more) const { return {more + suffix_, published_, out_}; }

  void add(TableRow row) const { out_.push_back(std::move(row)); }

  /// A claim of print without an interval of ours: same behaviour, or not.
  void add_claim(TableRow row, bool alike, const std::string& why) const {
    if (!std::isnan(row.published)) {
      row.verdict = alike ? "shape" : "differs";
      row.why = why;
    }
    out_.push_back(std::move(row));
  }

 private:
  std::string suffix_;
  std::vector<PublishedFigure> published_;
  std::vector<TableRow>& out_;
};

struct Moments {
  double mean = 0.0, deviation = 0.0;
  std::uint64_t n = 0;
};

Moments moments(const std::vector<double>& values) {
  Moments out;
  out.n = values.size();
  for (const double value : values) out.mean += value / static_cast<double>(out.n);
  for (const double value : values) out.deviation += (value - out.mean) * (value - out.mean);
  out.deviation = out.n > 1 ? std::sqrt(out.deviation / static_cast<double>(out.n - 1)) : 0.0;
  return out;
}

void add_counts(const ModelTable& table, const CellTables& out) {
  const auto n = static_cast<std::uint64_t>(table.models.size());
  const auto add = [&](const char* name, double value) {
    out.add(out.row("Models", name, "number", "", value, table.trials));
  };
  add("identified and validated or failed", static_cast<double>(n));
  add("not identified", table.not_identified);
  add("not validated", table.not_validated);
  add("without a continuous model (orders selected from)", table.not_continuous);
  if (table.failed_trials > 0) add("blocks that failed whole", static_cast<double>(table.failed_trials));
}

void add_figure_4(const ModelTable& table, const CellTables& out) {
  std::map<int, std::vector<double>> by_order;
  for (const ModelRow& model : table.models) {
    if (model.state == ModelState::ok) by_order[model.order].push_back(model.agreement);
  }
  for (const auto& [order, values] : by_order) {
    const EmpiricalCdf cdf(values);
    const std::string name = "n = " + std::to_string(order);
    const std::pair<const char*, double> quantiles[] = {{"smallest d1", 0.0},
                                                        {"lower quartile", 0.25},
                                                        {"median", 0.5},
                                                        {"upper quartile", 0.75},
                                                        {"largest d1", 1.0}};
    for (const auto& [quantity, p] : quantiles)
      out.add(out.row("Fig. 4", name, quantity, "", cdf.quantile(p), values.size()));
    out.add(out.row("Fig. 4", name, "share of adequate models (d1 from 0.80)", "%",
                    100.0 * (1.0 - cdf(0.8 - 1e-12)), values.size()));
  }
}

void add_artifacts(const ModelTable& table, const Selected& selected, const std::string& name,
                   const CellTables& out) {
  const auto share = [&](const std::vector<std::size_t>& set, std::uint64_t& n) {
    double with = 0.0;
    n = 0;
    for (const std::size_t i : set) {
      const int analysis = table.models[i].analysis;
      if (analysis < 0) continue;
      ++n;
      with += table.analyses[static_cast<std::size_t>(analysis)].artifacts > 0 ? 1.0 : 0.0;
    }
    return n > 0 ? 100.0 * with / static_cast<double>(n) : 0.0;
  };
  std::uint64_t n_all = 0, n_best = 0, n_candidates = 0;
  const double all = share(selected.all, n_all), best = share(selected.best, n_best),
               candidates = share(selected.candidates, n_candidates);
  const char* quantity = "models with a resonance that the truth does not have";
  out.add(out.row("Section 4", name + ", all", quantity, "%", all, n_all));
  out.add(out.row("Section 4", name + ", best by d1", quantity, "%", best, n_best));
  if (n_candidates == 0) return;
  std::uint64_t n_accepted = 0;
  const double accepted = share(selected.accepted, n_accepted);
  out.add(out.row("Section 4", name + ", norm below the limit", quantity, "%", accepted, n_accepted));
  TableRow row = out.row("Section 4", name + ", candidates", quantity, "%", candidates, n_candidates);
  if (candidates == 0.0 && best > 0.0) {
    row.verdict = std::isnan(row.published) ? "" : "exact";
    out.add(std::move(row));
    return;
  }
  out.add_claim(std::move(row), candidates < best,
                best == 0.0 ? "the best by d1 have none either: nothing to tell apart"
                            : "the norm's limit removes " +
                                  significant(100.0 * (1.0 - candidates / best), 3) + " % of them");
}

void add_selection(const ModelTable& table, const Selection& selection, const Selected& selected,
                   const CellTables& out) {
  const std::string name = "n = " + std::to_string(selection.order);
  out.add(out.row("Section 4", name, "limit of the norm", "", selected.limit, selected.all.size()));
  const auto count = [&](const char* quantity, const std::vector<std::size_t>& set) {
    out.add(out.row("Section 4", name, quantity, "", static_cast<double>(set.size()), selected.all.size()));
  };
  count("models with norm below the limit", selected.accepted);
  count("candidates", selected.candidates);
  add_artifacts(table, selected, name, out);
  if (selected.candidates.empty()) return;
  std::vector<double> past;
  for (const std::size_t i : selected.candidates) past.push_back(table.models[i].past);
  const EmpiricalCdf cdf(past);
  const double low = cdf.quantile(0.0), high = cdf.quantile(1.0);
  const bool inside = low >= 250.0 && high <= 700.0;
  out.add_claim(out.row("Section 4", name, "smallest p of the candidates", "", low, past.size()), inside,
                "p of the candidates lies between 250 and 700 in print");
  out.add_claim(out.row("Section 4", name, "largest p of the candidates", "", high, past.size()), inside,
                "p of the candidates lies between 250 and 700 in print");
  out.add(out.row("Section 4", name, "median d1 of the candidates", "",
                  table.models[selected.candidates[selected.candidates.size() / 2]].agreement, past.size()));
}

void add_mode(const ModelTable& table, const Selected& selected, std::size_t mode, const CellTables& out) {
  std::vector<double> periods, dampings;
  std::uint64_t analysed = 0;
  for (const std::size_t i : selected.candidates) {
    if (table.models[i].analysis < 0) continue;
    ++analysed;
    const ModelAnalysisRow& analysis = table.analyses[static_cast<std::size_t>(table.models[i].analysis)];
    if (!(analysis.period_s[mode] > 0.0)) continue;
    periods.push_back(analysis.period_s[mode]);
    dampings.push_back(analysis.damping[mode]);
  }
  const std::string name = kTrackedModes[mode].name;
  out.add(out.row(
      "Section 5.1", name, "candidates that have the mode", "%",
      analysed > 0 ? 100.0 * static_cast<double>(periods.size()) / static_cast<double>(analysed) : 0.0,
      analysed));
  if (periods.empty()) return;
  const auto add = [&](const std::vector<double>& values, const char* quantity, const char* deviation,
                       const char* unit) {
    const Moments m = moments(values);
    TableRow mean = out.row("Section 5.1", name, quantity, unit, m.mean, m.n);
    if (m.n > 1) {
      mean.low = m.mean - kSpread * m.deviation;
      mean.high = m.mean + kSpread * m.deviation;
      mean.why = kOneRecord;
    }
    judge_by_order(mean, "the candidates' spread does not hold the printed value, which the truth has");
    out.add(std::move(mean));
    TableRow spread = out.row("Section 5.1", name, deviation, unit, m.deviation, m.n);
    const double ratio = spread.published > 0.0 ? m.deviation / spread.published : 0.0;
    out.add_claim(std::move(spread), ratio > 1.0 / 3.0 && ratio < 3.0, "one flight test: no interval");
  };
  add(periods, "T_P", "standard deviation of T_P", "s");
  add(dampings, "D", "standard deviation of D", "");
}

void add_levels(const ModelTable& table, const Selected& selected, const CellTables& out) {
  for (std::size_t k = 0; k < kJudged.size(); ++k) {
    std::array<std::uint64_t, 4> level{}, approval{};
    std::uint64_t n = 0;
    for (const std::size_t i : selected.candidates) {
      if (table.models[i].analysis < 0) continue;
      const ModelAnalysisRow& analysis = table.analyses[static_cast<std::size_t>(table.models[i].analysis)];
      if (analysis.level[k] == 0) continue;
      ++n;
      ++level[static_cast<std::size_t>(analysis.level[k])];
      ++approval[static_cast<std::size_t>(analysis.approval[k])];
    }
    if (n == 0) continue;
    const auto most = [](const std::array<std::uint64_t, 4>& counts) {
      return std::max_element(counts.begin(), counts.end()) - counts.begin();
    };
    const auto percent = [&](std::uint64_t count) {
      return significant(100.0 * static_cast<double>(count) / static_cast<double>(n), 3) +
             " % of the candidates";
    };
    TableRow row = out.row("Section 5.2", kJudged[k].name, "ADS-33 level (boundary unverified)", "",
                           static_cast<double>(most(level)), n);
    row.why = percent(level[static_cast<std::size_t>(most(level))]);
    judge_exact(row, 1.0, "campaigns/candidates/README.md");
    out.add(std::move(row));
    TableRow pilots =
        out.row("Section 5.1", kJudged[k].name, "CS-27 pilots (0: no approval; boundary unverified)", "",
                static_cast<double>(most(approval) == 3 ? 0 : most(approval)), n);
    pilots.why = percent(approval[static_cast<std::size_t>(most(approval))]);
    judge_exact(pilots, 1.0, "campaigns/candidates/README.md");
    out.add(std::move(pilots));
  }
}

}  // namespace

Result<std::vector<TableRow>> tables(const CampaignSpec& spec, const RowSource& rows) {
  const auto published = decode_published(spec);
  if (!published) return fail(published.error());
  std::vector<TableRow> out;
  for (std::uint32_t cell = 0; cell < spec.cells.size(); ++cell) {
    const auto own = spec_of_cell(spec, cell);
    if (!own) return fail(own.error());
    const auto decoded = decode_candidates(*own);
    if (!decoded) return fail(decoded.error());
    const ModelTable table = read_models(cell, rows);
    if (table.models.empty()) continue;
    const CellTables cell_tables(
        spec.cells.size() == 1 ? "" : ", " + spec.cells[cell].name,
        compared_with_print(spec, cell) ? *published : std::vector<PublishedFigure>{}, out);
    add_counts(table, cell_tables);
    add_figure_4(table, cell_tables);
    int highest = 0;
    for (const Selection& selection : decoded->selections) highest = std::max(highest, selection.order);
    for (const Selection& selection : decoded->selections) {
      const CellTables own_tables = cell_tables.with(", " + selection.limit_text());
      const Selected selected = select(table, selection);
      add_selection(table, selection, selected, own_tables);
      if (selection.order != highest || selected.candidates.empty()) continue;  // H analyses n = 18
      for (std::size_t mode = 0; mode < kTrackedModes.size(); ++mode)
        add_mode(table, selected, mode, own_tables);
      add_levels(table, selected, own_tables);
    }
  }
  // Table by table, each in the order of cells and selections.
  const auto place = [](const TableRow& row) {
    static constexpr std::array kTables = {"Models", "Fig. 4", "Section 4", "Section 5.1", "Section 5.2"};
    return std::find(kTables.begin(), kTables.end(), row.table) - kTables.begin();
  };
  std::stable_sort(out.begin(), out.end(),
                   [&](const TableRow& one, const TableRow& other) { return place(one) < place(other); });
  return out;
}

const SummaryStudy kSummaryStudy{"candidates", &tables, &figures};

}  // namespace fatmc::candidates
