// A row of `fatmc tables`, filled and judged: the same rules for every study.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "campaigns/base/published_figures.h"
#include "campaigns/base/study.h"
#include "core/stats/bootstrap.h"

namespace fatmc {

/// A row without numbers: NaN for published, value and interval.
TableRow table_row(std::string table, std::string row, std::string quantity, std::string unit);

/// The published figure of that table, row and quantity, or NaN.
double published_value(const std::vector<PublishedFigure>& figures, const TableRow& row);

/// Value and 95 % prediction interval of the mean over runs, for a campaign of `published_runs`, times `unit_factor` (100
/// for shares given in %). One value a run; NaNs are left out. n = values given.
void fill_mean(TableRow& row, std::span<const double> runs, std::uint64_t published_runs,
               double unit_factor = 1.0);

/// How resampled values of a statistic lie about its value.
enum class StatisticScale {
  additive,
  ratio,     ///< positive: differences of logarithms
  angle_deg  ///< differences modulo 360; half a turn and more says nothing: no interval
};

/// Value and 95 % prediction interval of any statistic of `runs` runs, by bootstrap over runs, widened by
/// t(n - 1)/z sqrt(n/(n - 1)) for what few runs leave unknown. Below kFewestRuns no interval, and why says so: resampling
/// so few holds far less than it promises (a median of 4 runs: 82 %).
inline constexpr std::size_t kFewestRuns = 8;
void fill_statistic(TableRow& row, std::size_t runs, std::size_t published_runs,
                    const RunStatistic& statistic, StatisticScale scale = StatisticScale::additive);

/// The same for a smallest or largest value, over the lines for instance, of a statistic of runs: it lies further out the fewer
/// runs there are. Of twice as many runs as published and more `value` is the mean over blocks of the published size. Beside
/// print, why says what such intervals were found to hold (`held`: tests/validation/prediction_intervals.py) unless ours stands
/// on ten times the published runs, and where there are fewer runs than published.
void fill_extreme(TableRow& row, std::size_t runs, std::size_t published_runs, const RunStatistic& statistic,
                  std::string_view held, StatisticScale scale = StatisticScale::additive);

/// Share of runs with a property, in %, and the 95 % prediction interval of that share among `published_runs` further ones:
/// quantiles of the beta-binomial law with Jeffreys' prior, Beta(hits + 1/2, runs - hits + 1/2).
void fill_share(TableRow& row, std::uint64_t hits, std::uint64_t runs, std::uint64_t published_runs);

/// Keeps the interval inside what the quantity can be; without an interval there is none afterwards.
void clamp_interval(TableRow& row, double lowest, double highest);

/// Verdict where something is printed: `match` inside [low, high]; else `shape` if `alike`, or `differs`, with `reason`
/// appended to row.why. No interval: no verdict, and why says so.
void judge(TableRow& row, bool alike, std::string_view reason);

/// `alike` = same sign and order of magnitude: |log10(value / published)| <= 1/2, and for decibels no more than 10 dB apart,
/// too; published 0: never.
void judge_by_order(TableRow& row, std::string_view reason);

/// "Less than row.published" is printed: `match` where the interval begins below that; else `shape` by order, or `differs`.
void judge_upper_bound(TableRow& row, std::string_view reason);

/// "More than row.published" is printed, likewise: `match` where the interval ends above that.
void judge_lower_bound(TableRow& row, std::string_view reason);

/// `alike` = both on the same side of a nominal value (75 % of a nominal 75 % region).
void judge_by_side(TableRow& row, double nominal, std::string_view reason);

/// `exact` for a figure without scatter whose value rounds to the printed digits (`last_digit`: 0.01 for two decimals);
/// else as judge_by_order without an interval.
void judge_exact(TableRow& row, double last_digit, std::string_view reason);

/// For a figure that names a kind, a level for instance, where near is no virtue: `match` if equal, else `differs`.
void judge_category(TableRow& row, std::string_view reason);

}  // namespace fatmc
