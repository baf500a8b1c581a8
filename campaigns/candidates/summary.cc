#include "campaigns/candidates/summary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "campaigns/base/prepared_trials.h"
#include "campaigns/base/verdict.h"
#include "campaigns/candidates/judged_models.h"
#include "core/base/text.h"
#include "core/stats/empirical.h"

namespace fatmc::candidates {
namespace {

constexpr double kSpread = 1.96;  // standard deviations of an interval
constexpr const char* kOneRecord =
    "one flight test: the interval is the spread of the candidates, which H takes for the uncertainty";

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kNoModel = "no model has a norm below the limit";

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
      row.why += (row.why.empty() ? "" : "; ") + why;
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
  std::map<int, std::vector<double>> by_order, rms_by_order;
  for (const ModelRow& model : table.models) {
    if (model.state != ModelState::ok) continue;
    by_order[model.order].push_back(model.agreement);
    rms_by_order[model.order].push_back(model.rms);
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
    out.add(out.row("Fig. 4", name, "share of adequate models (J_rms up to 3.5)", "%",
                    100.0 * EmpiricalCdf(rms_by_order[order])(3.5), values.size()));
  }
}

void add_artifacts(const JudgedModels& models, const Selected& selected, const std::string& name,
                   const CellTables& out) {
  const auto share = [&](const std::vector<std::size_t>& set) {
    double with = 0.0;
    for (const std::size_t i : set)
      with += models.of(i) != nullptr && models.of(i)->artifacts > 0 ? 1.0 : 0.0;
    const auto n = static_cast<double>(models.judged(set));
    return n > 0.0 ? 100.0 * with / n : kNone;
  };
  const auto row_of = [&](const char* which, const std::vector<std::size_t>& set) {
    TableRow row = out.row("Section 4", name + which, "models with a resonance that the truth does not have",
                           "%", share(set), models.judged(set));
    row.why = models.left_out(set);
    return row;
  };
  out.add(row_of(", all", selected.all));
  out.add(row_of(", best by d1", selected.best));
  out.add(row_of(", norm below the limit", selected.accepted));
  TableRow row = row_of(", candidates", selected.candidates);
  const double best = share(selected.best), candidates = row.value;
  if (selected.candidates.empty()) return out.add_claim(std::move(row), false, kNoModel);
  out.add_claim(std::move(row), best > 0.0 && candidates < 0.5 * best,
                !(best > 0.0) ? "the best by d1 have none either: nothing to tell apart"
                              : "among the best by d1 " + significant(best, 3) +
                                    " % have one; alike: at most half as many among the candidates");
}

void add_pasts(const ModelTable& table, const Selected& selected, const std::string& name,
               const CellTables& out) {
  constexpr double kLow = 250.0, kHigh = 700.0;  // H 4.3
  std::vector<double> past;
  for (const std::size_t i : selected.candidates) past.push_back(table.models[i].past);
  double longest = 0.0;
  for (const ModelRow& model : table.models) longest = std::max(longest, static_cast<double>(model.past));
  const double low = past.empty() ? kNone : *std::min_element(past.begin(), past.end()),
               high = past.empty() ? kNone : *std::max_element(past.begin(), past.end());
  const auto add = [&](const char* quantity, double value) {
    TableRow row = out.row("Section 4", name, quantity, "", value, past.size());
    if (longest < kHigh && !std::isnan(row.published)) {
      row.why = "no verdict: p ends at " + significant(longest, 4) + " here";
      return out.add(std::move(row));
    }
    out.add_claim(std::move(row), low >= kLow && high <= kHigh,
                  past.empty() ? kNoModel : "p of the candidates lies between 250 and 700 in print");
  };
  add("smallest p of the candidates", low);
  add("largest p of the candidates", high);
}

void add_selection(const JudgedModels& models, const Selection& selection, const Selected& selected,
                   const CellTables& out) {
  const std::string name = "n = " + std::to_string(selection.order);
  out.add(out.row("Section 4", name, "limit of the norm", "", selected.limit, selected.all.size()));
  const auto count = [&](const char* quantity, const std::vector<std::size_t>& set) {
    out.add(out.row("Section 4", name, quantity, "", static_cast<double>(set.size()), selected.all.size()));
  };
  count("models with norm below the limit", selected.accepted);
  count("candidates", selected.candidates);
  add_artifacts(models, selected, name, out);
  add_pasts(models.table, selected, name, out);
  if (selected.candidates.empty()) return;
  out.add(out.row("Section 4", name, "median d1 of the candidates", "",
                  models.table.models[selected.candidates[selected.candidates.size() / 2]].agreement,
                  selected.candidates.size()));
}

/// Mean and standard deviation over the candidates of a quantity that print gives with both.
void add_moments(const Selected& selected, const std::vector<double>& values, const std::string& name,
                 const char* quantity, const char* deviation, const char* unit, const CellTables& out) {
  const Moments m = moments(values);
  TableRow mean = out.row("Section 5.1", name, quantity, unit, values.empty() ? kNone : m.mean, m.n);
  TableRow spread = out.row("Section 5.1", name, deviation, unit, m.n > 1 ? m.deviation : kNone, m.n);
  if (m.n < 2) {
    const std::string why = selected.candidates.empty() ? kNoModel
                            : m.n == 0                  ? "no candidate has the mode"
                                                        : "one candidate alone has the mode: no spread";
    out.add_claim(std::move(mean), false, why);
    return out.add_claim(std::move(spread), false, why);
  }
  mean.low = m.mean - kSpread * m.deviation;
  mean.high = m.mean + kSpread * m.deviation;
  mean.why = kOneRecord;
  judge_by_order(mean, "the candidates' spread does not hold the printed value, which the truth has");
  out.add(std::move(mean));
  const double ratio = spread.published > 0.0 ? std::log10(m.deviation / spread.published) : kNone;
  out.add_claim(std::move(spread), std::abs(ratio) <= 0.5,
                "one flight test: no interval; alike: within half a decade");
}

void add_mode(const JudgedModels& models, const Selected& selected, std::size_t mode, const CellTables& out) {
  std::vector<double> periods, dampings;
  for (const std::size_t i : selected.candidates) {
    const ModelAnalysis* analysis = models.of(i);
    if (analysis == nullptr || !(analysis->period_s[mode] > 0.0)) continue;
    periods.push_back(analysis->period_s[mode]);
    dampings.push_back(analysis->damping[mode]);
  }
  const std::string name = kTrackedModes[mode].name;
  const auto judged = models.judged(selected.candidates);
  TableRow have = out.row(
      "Section 5.1", name, "candidates that have the mode", "%",
      judged > 0 ? 100.0 * static_cast<double>(periods.size()) / static_cast<double>(judged) : kNone, judged);
  have.why = models.left_out(selected.candidates);
  out.add(std::move(have));
  add_moments(selected, periods, name, "T_P", "standard deviation of T_P", "s", out);
  add_moments(selected, dampings, name, "D", "standard deviation of D", "", out);
}

/// The value that most candidates have, and the share that has it.
struct Majority {
  std::size_t value = 0;
  std::string share;
};

Majority majority(const std::array<std::uint64_t, 4>& counts, std::uint64_t n) {
  const auto most = std::max_element(counts.begin(), counts.end());
  return {
      static_cast<std::size_t>(most - counts.begin()),
      significant(100.0 * static_cast<double>(*most) / static_cast<double>(n), 3) + " % of the candidates"};
}

void add_levels(const JudgedModels& models, const Selected& selected, const CellTables& out) {
  for (std::size_t k = 0; k < kJudged.size(); ++k) {
    std::array<std::uint64_t, 4> level{}, approval{};
    std::uint64_t n = 0;
    double diverging = 0.0;
    for (const std::size_t i : selected.candidates) {
      const ModelAnalysis* analysis = models.of(i);
      if (analysis == nullptr || analysis->level[k] == 0) continue;
      ++n;
      ++level[static_cast<std::size_t>(analysis->level[k])];
      ++approval[static_cast<std::size_t>(analysis->approval[k])];
      diverging += analysis->diverging[k] ? 1.0 : 0.0;
    }
    TableRow row =
        out.row("Section 5.2", kJudged[k].name, "ADS-33 level (boundary unverified)", "", kNone, n);
    TableRow pilots = out.row("Section 5.1", kJudged[k].name,
                              "CS-27 pilots (0: no approval; boundary unverified)", "", kNone, n);
    if (n == 0) {
      out.add_claim(std::move(row), false, kNoModel);
      out.add_claim(std::move(pilots), false, kNoModel);
      continue;
    }
    const Majority ads = majority(level, n), cs = majority(approval, n);
    row.value = static_cast<double>(ads.value);
    row.why = ads.share;
    judge_category(row, "campaigns/candidates/README.md");
    out.add(std::move(row));
    pilots.value = cs.value == 3 ? 0.0 : static_cast<double>(cs.value);
    pilots.why = cs.share;
    judge_category(pilots, "campaigns/candidates/README.md");
    out.add(std::move(pilots));
    out.add(out.row("Section 5.2", kJudged[k].name, "candidates whose response diverges without oscillating",
                    "%", 100.0 * diverging / static_cast<double>(n), n));
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
    const auto read = read_models(cell, rows);
    if (!read) return fail(read.error());
    const ModelTable& table = *read;
    if (table.models.empty()) continue;
    const auto judged = judge_models(table, decoded->truth);
    if (!judged) return fail(judged.error());
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
      add_selection(*judged, selection, selected, own_tables);
      if (selection.order != highest) continue;  // H analyses n = 18
      for (std::size_t mode = 0; mode < kTrackedModes.size(); ++mode)
        add_mode(*judged, selected, mode, own_tables);
      add_levels(*judged, selected, own_tables);
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
