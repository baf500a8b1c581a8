#include "campaigns/base/verdict.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fatmc {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

void add_reason(TableRow& row, std::string_view reason) {
  if (reason.empty()) return;
  row.why += (row.why.empty() ? "" : "; ") + std::string(reason);
}

bool same_order(const TableRow& row) {
  const double ratio = row.value / row.published;
  return ratio > 0.0 && std::abs(std::log10(ratio)) <= 0.5;
}

}  // namespace

TableRow table_row(std::string table, std::string row, std::string quantity, std::string unit) {
  TableRow out;
  out.table = std::move(table);
  out.row = std::move(row);
  out.quantity = std::move(quantity);
  out.unit = std::move(unit);
  out.published = out.value = out.low = out.high = kNone;
  return out;
}

double published_value(const std::vector<PublishedFigure>& figures, const TableRow& row) {
  const PublishedFigure* figure = find_published(figures, row.table, row.row, row.quantity);
  return figure != nullptr ? figure->value : kNone;
}

void fill_mean(TableRow& row, std::span<const double> runs, std::uint64_t published_runs,
               double unit_factor) {
  std::vector<double> finite;
  for (const double value : runs) {
    if (std::isfinite(value)) finite.push_back(value);
  }
  row.n = runs.size();
  if (finite.empty()) return;
  const RunMean mean = mean_over_runs(finite);
  row.value = unit_factor * mean.mean;
  if (mean.n < 2) return;
  const Interval interval = prediction_interval(mean, published_runs);
  row.low = unit_factor * interval.low;
  row.high = unit_factor * interval.high;
}

void fill_statistic(TableRow& row, std::size_t runs, std::size_t published_runs,
                    const RunStatistic& statistic) {
  row.n = runs;
  if (runs == 0) return;
  std::vector<std::size_t> all(runs);
  for (std::size_t k = 0; k < runs; ++k) all[k] = k;
  row.value = statistic(all);
  const Interval interval = bootstrap_prediction(runs, published_runs, statistic);
  if (!std::isfinite(interval.low) || !std::isfinite(interval.high)) return;
  row.low = interval.low;
  row.high = interval.high;
}

void fill_share(TableRow& row, std::uint64_t hits, std::uint64_t runs, std::uint64_t published_runs) {
  row.n = runs;
  if (runs == 0) return;
  const auto n = static_cast<double>(runs);
  const double share = static_cast<double>(hits) / n;
  row.value = 100.0 * share;
  if (runs < 2) return;
  const double m = 1.0 / (1.0 / n + 1.0 / static_cast<double>(published_runs));
  constexpr double z = 1.959963984540054;
  const double centre = (share + z * z / (2.0 * m)) / (1.0 + z * z / m);
  const double half = z / (1.0 + z * z / m) * std::sqrt(share * (1.0 - share) / m + z * z / (4.0 * m * m));
  // All or none: the end of the interval is the share itself, which rounding would put just inside.
  row.low = hits == 0 ? 0.0 : 100.0 * std::max(0.0, centre - half);
  row.high = hits == runs ? 100.0 : 100.0 * std::min(1.0, centre + half);
}

void judge(TableRow& row, bool alike, std::string_view reason) {
  if (std::isnan(row.published)) return;
  if (std::isnan(row.low) || std::isnan(row.high)) {
    add_reason(row, "one run has no scatter: no interval, no verdict");
    return;
  }
  if (row.published >= row.low && row.published <= row.high) {
    row.verdict = "match";
    return;
  }
  row.verdict = alike ? "shape" : "differs";
  add_reason(row, reason);
}

void judge_by_order(TableRow& row, std::string_view reason) { judge(row, same_order(row), reason); }

void judge_upper_bound(TableRow& row, std::string_view reason) {
  if (std::isnan(row.published)) return;
  add_reason(row, "printed is a bound, less than");
  if (!(row.low < row.published)) return judge(row, same_order(row), reason);
  row.verdict = "match";
}

void judge_by_side(TableRow& row, double nominal, std::string_view reason) {
  judge(row, (row.published - nominal) * (row.value - nominal) > 0.0, reason);
}

void judge_exact(TableRow& row, double last_digit, std::string_view reason) {
  if (std::isnan(row.published) || std::isnan(row.value)) return;
  if (std::round(row.value / last_digit) == std::round(row.published / last_digit)) {
    row.verdict = "exact";
    return;
  }
  row.verdict = same_order(row) ? "shape" : "differs";
  add_reason(row, reason);
}

}  // namespace fatmc
