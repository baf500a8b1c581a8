#include "campaigns/base/verdict.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/stats/intervals.h"

namespace fatmc {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

void add_reason(TableRow& row, std::string_view reason) {
  if (reason.empty()) return;
  row.why += (row.why.empty() ? "" : "; ") + std::string(reason);
}

bool same_order(const TableRow& row) {
  const double ratio = row.value / row.published;
  if (row.unit == "dB" && std::abs(row.value - row.published) > 10.0) return false;
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
                    const RunStatistic& statistic, StatisticScale scale) {
  row.n = runs;
  if (runs == 0) return;
  std::vector<std::size_t> all(runs);
  for (std::size_t k = 0; k < runs; ++k) all[k] = k;
  row.value = statistic(all);
  if (runs < kFewestRuns) {
    add_reason(row, "fewer than " + std::to_string(kFewestRuns) + " runs: no interval");
    return;
  }
  const double whole = row.value;
  const RunStatistic scaled = [&](std::span<const std::size_t> picks) {
    const double value = statistic(picks);
    if (scale == StatisticScale::ratio) return value > 0.0 ? std::log(value / whole) : kNone;
    if (scale == StatisticScale::angle_deg) return std::remainder(value - whole, 360.0);
    return value - whole;
  };
  const Interval interval = bootstrap_prediction(runs, published_runs, scaled);
  if (!std::isfinite(interval.low) || !std::isfinite(interval.high)) return;
  const auto n = static_cast<double>(runs);
  constexpr double z = 1.959963984540054;
  const double wider = t_quantile(0.975, n - 1.0) / z * std::sqrt(n / (n - 1.0));
  const double low = wider * interval.low, high = wider * interval.high;
  if (scale == StatisticScale::angle_deg && high - low >= 360.0) {
    add_reason(row, "runs scatter over the whole turn: no interval");
    return;
  }
  row.low = scale == StatisticScale::ratio ? whole * std::exp(low) : whole + low;
  row.high = scale == StatisticScale::ratio ? whole * std::exp(high) : whole + high;
}

void fill_extreme(TableRow& row, std::size_t runs, std::size_t published_runs, const RunStatistic& statistic,
                  std::string_view held, StatisticScale scale) {
  fill_statistic(row, runs, published_runs, statistic, scale);
  if (runs >= 2 * published_runs) {
    std::vector<double> blocks;
    std::vector<std::size_t> picks(published_runs);
    for (std::size_t first = 0; first + published_runs <= runs; first += published_runs) {
      std::iota(picks.begin(), picks.end(), first);
      if (const double value = statistic(picks); std::isfinite(value)) blocks.push_back(value);
    }
    row.value = blocks.empty() ? kNone : mean_over_runs(blocks).mean;
  }
  if (std::isnan(row.published)) return;
  const std::string published = std::to_string(published_runs) + " runs";
  if (runs < published_runs) {
    add_reason(row, "an extreme of " + std::to_string(runs) + " runs lies further out than one of " +
                        published + "; the interval is one of " + published);
  } else if (runs < 10 * published_runs && std::isfinite(row.low)) {
    add_reason(row,
               "an extreme: intervals from " + published + " hold " + std::string(held) + " % instead of 95");
  }
}

void fill_share(TableRow& row, std::uint64_t hits, std::uint64_t runs, std::uint64_t published_runs) {
  row.n = runs;
  if (runs == 0) return;
  const auto n = static_cast<double>(runs), h = static_cast<double>(hits),
             m = static_cast<double>(published_runs);
  row.value = 100.0 * h / n;
  if (runs < 2) return;
  // P(K = k) = C(m, k) B(k + a, m - k + b) / B(a, b)
  const double a = h + 0.5, b = n - h + 0.5;
  const auto log_beta = [](double x, double y) {
    return std::lgamma(x) + std::lgamma(y) - std::lgamma(x + y);
  };
  double sum = 0.0;
  bool low_found = false;
  for (std::uint64_t k = 0; k <= published_runs; ++k) {
    const auto x = static_cast<double>(k);
    sum += std::exp(std::lgamma(m + 1.0) - std::lgamma(x + 1.0) - std::lgamma(m - x + 1.0) +
                    log_beta(x + a, m - x + b) - log_beta(a, b));
    if (!low_found && sum >= 0.025) {
      row.low = 100.0 * x / m;
      low_found = true;
    }
    if (sum >= 0.975) {
      row.high = 100.0 * x / m;
      return;
    }
  }
  row.high = 100.0;
}

void clamp_interval(TableRow& row, double lowest, double highest) {
  if (std::isnan(row.low) || std::isnan(row.high)) return;
  row.low = std::max(lowest, row.low);
  row.high = std::min(highest, row.high);
}

void judge(TableRow& row, bool alike, std::string_view reason) {
  if (std::isnan(row.published)) return;
  if (std::isnan(row.low) || std::isnan(row.high)) {
    add_reason(row, row.n < 2 ? "one run has no scatter: no interval, no verdict" : "no verdict");
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

void judge_lower_bound(TableRow& row, std::string_view reason) {
  if (std::isnan(row.published)) return;
  add_reason(row, "printed is a bound, more than");
  if (!(row.high > row.published)) return judge(row, same_order(row), reason);
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

void judge_category(TableRow& row, std::string_view reason) {
  if (std::isnan(row.published) || std::isnan(row.value)) return;
  row.verdict = row.value == row.published ? "match" : "differs";
  if (row.verdict == "differs") add_reason(row, reason);
}

}  // namespace fatmc
