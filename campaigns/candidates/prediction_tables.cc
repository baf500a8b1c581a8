// Tables of what the candidates predict: modes, CS-27 and ADS-33 (H 5.1, 5.2).
#include <algorithm>
#include <array>

#include "campaigns/candidates/cell_tables.h"
#include "core/base/text.h"
#include "core/stats/empirical.h"

namespace fatmc::candidates {
namespace {

constexpr double kSpread = 1.96;  // standard deviations of an interval
constexpr const char* kOneRecord =
    "one flight test: the interval is the spread of the candidates, which H takes for the uncertainty";

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
  if (m.n < kFewestRuns) {
    const double ratio = spread.published > 0.0 ? std::log10(m.deviation / spread.published) : kNone;
    return out.add_claim(std::move(spread), std::abs(ratio) <= 0.5,
                         "fewer than " + std::to_string(kFewestRuns) +
                             " candidates: no interval; alike: within half a decade");
  }
  const auto deviation_of = [&](std::span<const std::size_t> picks) {
    std::vector<double> picked;
    for (const std::size_t k : picks) picked.push_back(values[k]);
    return moments(picked).deviation;
  };
  fill_statistic(spread, values.size(), selected.best.size(), deviation_of, StatisticScale::ratio);
  spread.why += (spread.why.empty() ? "" : "; ") + std::string(kRelatedModels);
  judge_by_order(spread, "");
  out.add(std::move(spread));
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

/// A category that most candidates have: its row's value, the categories of the middle 95 % of them as interval, and in why the
/// share that has it.
void fill_majority(TableRow& row, std::vector<double> categories) {
  const auto n = static_cast<std::uint64_t>(categories.size());
  double most = kNone;
  std::ptrdiff_t count = 0;
  for (const double category : categories) {
    const auto here = std::count(categories.begin(), categories.end(), category);
    if (here > count || (here == count && category < most)) most = category, count = here;
  }
  row.value = most;
  row.n = n;
  // Whole categories: the order statistics at and beyond the quantiles.
  std::sort(categories.begin(), categories.end());
  const auto cut = static_cast<std::size_t>(0.025 * static_cast<double>(n));
  row.low = categories[cut];
  row.high = categories[categories.size() - 1 - cut];
  TableRow share = table_row("", "", "", "%");
  fill_share(share, static_cast<std::uint64_t>(count), n, n);
  row.why = significant(share.value, 3) + " % of the candidates";
  if (n > 1) row.why += " (" + significant(share.low, 3) + " to " + significant(share.high, 3) + " %)";
  row.why += "; low and high: levels of 95 % of them";
}

void add_levels(const JudgedModels& models, const Selected& selected, const CellTables& out) {
  for (std::size_t k = 0; k < kJudged.size(); ++k) {
    std::vector<double> level, pilots_of;
    double diverging = 0.0;
    for (const std::size_t i : selected.candidates) {
      const ModelAnalysis* analysis = models.of(i);
      if (analysis == nullptr || analysis->level[k] == 0) continue;
      level.push_back(analysis->level[k]);
      pilots_of.push_back(analysis->approval[k] == 3 ? 0.0 : analysis->approval[k]);
      diverging += analysis->diverging[k] ? 1.0 : 0.0;
    }
    const std::uint64_t n = level.size();
    TableRow row =
        out.row("Section 5.2", kJudged[k].name, "ADS-33 level (boundary unverified)", "", kNone, n);
    TableRow pilots = out.row("Section 5.1", kJudged[k].name,
                              "CS-27 pilots (0: no approval; boundary unverified)", "", kNone, n);
    if (n == 0) {
      out.add_claim(std::move(row), false, kNoModel);
      out.add_claim(std::move(pilots), false, kNoModel);
      continue;
    }
    for (const auto& [filled, categories] : {std::pair{&row, &level}, std::pair{&pilots, &pilots_of}}) {
      fill_majority(*filled, *categories);
      judge_category(*filled, "campaigns/candidates/README.md");
      out.add(std::move(*filled));
    }
    out.add(out.row("Section 5.2", kJudged[k].name, "candidates whose response diverges without oscillating",
                    "%", 100.0 * diverging / static_cast<double>(n), n));
  }
}

}  // namespace

void add_prediction_tables(const JudgedModels& models, const Selected& selected, const CellTables& out) {
  for (std::size_t mode = 0; mode < kTrackedModes.size(); ++mode) add_mode(models, selected, mode, out);
  add_levels(models, selected, out);
}

}  // namespace fatmc::candidates
