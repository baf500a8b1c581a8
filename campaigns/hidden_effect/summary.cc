#include "campaigns/hidden_effect/summary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "campaigns/hidden_effect/row_metrics.h"
#include "core/flight/effects/effect.h"
#include "core/stats/empirical.h"
#include "core/stats/intervals.h"

namespace fatmc::hidden_effect {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kTable = "Hidden effects";

std::optional<double> metric(const TrialRow& row, std::string_view name) {
  for (const auto& [key, value] : row.metrics) {
    if (key == name) return value;
  }
  return std::nullopt;
}

struct Count {
  std::uint64_t hits = 0, n = 0;
  void add(bool hit) {
    ++n;
    hits += hit ? 1 : 0;
  }
};

/// What a pass over a cell's rows collects. A trial that diverged is in `diverged` alone: nothing was flown to diagnose.
struct CellResults {
  Count detected, named, right, both, any, holds, spurious, unknown, wrong, covered, diverged,
      right_of_detected;
  std::vector<double> class_size, error, gap;
  std::map<int, Count> right_by_effect;
  std::map<std::pair<int, int>, std::uint64_t> confusion;  ///< hidden, named (-1: none, -2: class or unknown)
  int hidden = 0;
};

void read_row(const TrialRow& row, CellResults& out) {
  out.diverged.add(row.outcome != "ok");
  if (row.outcome != "ok") return;
  const int first = static_cast<int>(metric(row, kHidden[0]).value_or(-1.0));
  const int second = static_cast<int>(metric(row, kHidden[1]).value_or(-1.0));
  const int verdict = static_cast<int>(metric(row, kVerdict).value_or(0.0));
  const double right = metric(row, kRightCount).value_or(0.0), count = metric(row, kNamedCount).value_or(0.0);
  out.hidden = (first >= 0 ? 1 : 0) + (second >= 0 ? 1 : 0);
  const bool detected = verdict != 0;
  out.detected.add(detected);
  out.unknown.add(verdict == 3);
  out.named.add(count > 0.0);
  out.spurious.add(metric(row, kSpurious).value_or(0.0) > 0.0 && right > 0.0);
  if (out.hidden == 0) return;
  out.right.add(right >= 1.0);
  if (detected) out.right_of_detected.add(right >= 1.0);
  out.any.add(right >= 1.0);
  out.both.add(right >= 2.0);
  out.wrong.add(verdict == 1 && right == 0.0);
  out.holds.add(metric(row, kClassHolds).value_or(0.0) > 0.5);
  if (count > 0.0) out.class_size.push_back(metric(row, kClassSize).value_or(1.0));
  if (const auto e = metric(row, kParameterError)) out.error.push_back(*e);
  if (const auto c = metric(row, kCovered)) out.covered.add(*c > 0.5);
  if (const auto g = metric(row, kGapLeft)) out.gap.push_back(*g);
  if (out.hidden == 1) {
    out.right_by_effect[first].add(right >= 1.0);
    const int named = verdict == 1   ? static_cast<int>(metric(row, kNamed[0]).value_or(-1.0))
                      : verdict == 0 ? -1
                                     : -2;
    ++out.confusion[{first, named}];
  }
}

class Rows {
 public:
  Rows(std::string cell, std::vector<TableRow>& out) : cell_(std::move(cell)), out_(out) {}
  void share(const std::string& quantity, const Count& count, const std::string& bar = "") {
    if (count.n == 0) return;
    const Interval interval = proportion_interval(count.hits, count.n);
    const double value = 100.0 * static_cast<double>(count.hits) / static_cast<double>(count.n);
    out_.push_back({kTable, cell_, quantity, "%", kNone, value, 100.0 * interval.low, 100.0 * interval.high,
                    count.n, "", bar});
  }
  void quantile(const std::string& quantity, const std::vector<double>& values, double p,
                const std::string& bar) {
    if (values.empty()) return;
    const double value = EmpiricalCdf(values).quantile(p);
    out_.push_back(
        {kTable, cell_, quantity, "%", kNone, 100.0 * value, kNone, kNone, values.size(), "", bar});
  }
  void mean(const std::string& quantity, const std::vector<double>& values, const std::string& bar) {
    if (values.empty()) return;
    const RunMean runs = mean_over_runs(values);
    const Interval interval = mean_interval(runs);
    out_.push_back(
        {kTable, cell_, quantity, "", kNone, runs.mean, interval.low, interval.high, runs.n, "", bar});
  }

 private:
  std::string cell_;
  std::vector<TableRow>& out_;
};

std::string effect_name(int number) {
  static const std::vector<Effect> all = effect_variants();
  if (number == -1) return "nothing";
  if (number < 0 || number >= static_cast<int>(all.size())) return "class or unknown";
  return all[static_cast<std::size_t>(number)].name();
}

void write_cell(const std::string& name, const CellResults& r, std::vector<TableRow>& out) {
  Rows rows(name, out);
  rows.share("diverged", r.diverged);
  if (r.hidden == 0) {
    rows.share("false alarm", r.detected, "bar: at most 1 %, upper bound 1.5 %");
    rows.share("false name", r.named);
    return;
  }
  rows.share("detected", r.detected);
  if (r.hidden == 2) {
    rows.share("both named", r.both, "bar: at least 90 %");
    rows.share("at least one named", r.any, "bar: at least 99 %");
  } else {
    rows.share("right name", r.right, "bar: at least 97 % at moderate size");
    rows.share("right name if detected", r.right_of_detected, "bar: at least 93 % at quarter size");
    rows.share("class contains the truth", r.holds, "bar: at least 99 %");
  }
  rows.mean("mean class size", r.class_size, "bar: at most 1.2");
  rows.share("confident wrong name", r.wrong, "bar: at most 3 %");
  rows.share("spurious further effect", r.spurious, "bar: at most 3 %");
  rows.share("unknown", r.unknown, "bar: at most 3 %; at least 95 % out of library, 60 % if absorbable");
  rows.quantile("parameter error, median", r.error, 0.5, "bar: at most 2 %");
  rows.quantile("parameter error, 90 % quantile", r.error, 0.9, "bar: at most 5 %");
  rows.share("95 % interval covers", r.covered, "bar: 92-98 %");
  rows.quantile("gap left on an unseen record, median", r.gap, 0.5, "bar: at most 1 %");
  rows.quantile("gap left on an unseen record, 90 % quantile", r.gap, 0.9, "bar: at most 5 %");
  for (const auto& [number, count] : r.right_by_effect)
    rows.share("right: " + effect_name(number), count, "bar: at least 90 %");
  for (const auto& [pair, n] : r.confusion) {
    if (pair.first == pair.second) continue;
    const Count count{n, r.right_by_effect.at(pair.first).n};
    rows.share("confusion: " + effect_name(pair.first) + " named " + effect_name(pair.second), count);
  }
}

Result<std::vector<TableRow>> tables(const CampaignSpec& spec, const RowSource& rows) {
  std::vector<TableRow> out;
  for (std::uint32_t c = 0; c < spec.cells.size(); ++c) {
    CellResults results;
    rows(c, [&](const TrialRow& row) { read_row(row, results); });
    if (results.diverged.n > 0) write_cell(spec.cells[c].name, results, out);
  }
  return out;
}

}  // namespace

const SummaryStudy kSummaryStudy{"hidden_effect", &tables};

}  // namespace fatmc::hidden_effect
