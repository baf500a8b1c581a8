#include "campaigns/coverage/snr_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "campaigns/base/line_runs.h"
#include "campaigns/base/verdict.h"
#include "campaigns/coverage/summary.h"
#include "core/stats/extreme_prediction.h"
#include "core/stats/intervals.h"

namespace fatmc::coverage {
namespace {

constexpr const char* kInputNames[] = {"xi_c", "eta_c", "zeta_c"};
constexpr const char* kFitted =
    "fitted: the amplitude of the excitation, printed nowhere, was chosen by the SNR figures of 5.2.3";
constexpr const char* kNormalEnd =
    "no 50 runs bound the smallest of 50 others from below: the lower end is that of a normal law, which "
    "holds 82 % "
    "(roll) to 97 % instead of 95";

// By `--scale 20` of both campaigns, and campaigns/stability/unknowns.toml.
constexpr const char* kYawSnrWhy =
    "no matter of the draw: 50 runs give 54 % here (Wilson's interval 40 to 67) and 46 % (33 to 60) in "
    "campaigns/stability, "
    "which flies the same with other random numbers, 1,000 runs 52.4 and 52.9 %; without the turn "
    "coordinator it is 38 %, "
    "the rest hangs on derivatives and amplitude";

// Smallest of the minima of 50 runs. A smallest value falls with the number of runs: more of them are taken in blocks of 50 and
// averaged, fewer have no counterpart in print.
void fill_smallest(TableRow& row, const std::vector<double>& minima) {
  constexpr std::size_t kBlock = kPublishedRepetitions;
  if (minima.size() < kBlock) {
    row.value = *std::min_element(minima.begin(), minima.end());
    row.why = "smallest of " + std::to_string(minima.size()) + " runs, beside one of " +
              std::to_string(kBlock) + " that is lower by their number alone";
    return;
  }
  std::vector<double> blocks;
  for (std::size_t first = 0; first + kBlock <= minima.size(); first += kBlock) {
    const auto begin = minima.begin() + static_cast<std::ptrdiff_t>(first);
    blocks.push_back(*std::min_element(begin, begin + kBlock));
  }
  row.value = mean_over_runs(blocks).mean;
  const Interval ranks = smallest_prediction(minima, kBlock);
  row.low = ranks.low;
  row.high = ranks.high;
  if (std::isfinite(ranks.low)) return;
  row.low = normal_smallest_prediction(minima, kBlock).low;
  row.why = kNormalEnd;
}

// Smallest (largest) over the lines of the median over the runs.
RunStatistic extreme_median(const SortedRuns& snr, std::size_t lines, bool largest) {
  return [&snr, lines, largest](std::span<const std::size_t> picks) {
    const RunCounts counts(snr.runs(), picks);
    double out = snr.quantile(0, 0.5, counts);
    for (std::size_t line = 1; line < lines; ++line) {
      const double median = snr.quantile(line, 0.5, counts);
      out = largest ? std::max(out, median) : std::min(out, median);
    }
    return out;
  };
}

std::string reason_for(const TableRow& row) {
  if (row.unit == "%") return kYawSnrWhy;
  return std::string(row.published > row.value ? "published higher" : "published lower") +
         "; the aerodynamic derivatives are not printed";
}

}  // namespace

void SnrSummary::add(const std::vector<double>& snr_db, std::size_t inputs) {
  inputs_ = inputs;
  runs_.push_back(snr_db);
}

void SnrSummary::add_rows(std::uint64_t trials, const std::string& suffix,
                          const std::vector<PublishedFigure>& published, std::vector<TableRow>& out) const {
  if (runs_.empty()) return;
  const std::size_t lines = runs_.front().size() / inputs_;
  for (std::size_t input = 0; input < inputs_; ++input) {
    const std::string name = inputs_ == 3 ? kInputNames[input] : "input " + std::to_string(input + 1);
    const auto append = [&](const std::string& quantity, const std::string& unit, const auto& fill) {
      TableRow row = table_row("Section 5.2.3", name, quantity, unit);
      row.published = published_value(published, row);
      if (unit == "%") row.quantity = "share of all " + quantity;
      row.row += suffix;
      row.n = runs_.size();
      fill(row);
      if (unit == "dB" && !std::isnan(row.published))
        row.why = kFitted + (row.why.empty() ? "" : "; " + row.why);
      // alike: a ratio within a factor of two (6 dB)
      judge(row, unit == "dB" && std::abs(row.published - row.value) < 6.0, reason_for(row));
      out.push_back(std::move(row));
    };
    LineRuns snr;
    std::vector<double> minima;
    for (const std::vector<double>& run : runs_) {
      std::vector<double> of_input;
      for (std::size_t line = 0; line < lines; ++line) of_input.push_back(run[line * inputs_ + input]);
      minima.push_back(*std::min_element(of_input.begin(), of_input.end()));
      snr.add(of_input);
    }
    append("smallest input SNR", "dB", [&](TableRow& row) { fill_smallest(row, minima); });
    const SortedRuns sorted(snr);
    for (const bool largest : {false, true}) {
      append(largest ? "largest median" : "smallest median", "dB", [&](TableRow& row) {
        fill_extreme(row, runs_.size(), kPublishedRepetitions, extreme_median(sorted, lines, largest),
                     "91 to 98");
      });
    }
    // A run without an estimate has no SNR that could suffice.
    const auto below = static_cast<std::uint64_t>(
        std::count_if(minima.begin(), minima.end(), [](double snr_db) { return snr_db < 20.0; }));
    append("runs with a line below 20 dB", "%", [&](TableRow& row) {
      fill_share(row, below + (trials - runs_.size()), trials, kPublishedRepetitions);
    });
  }
}

}  // namespace fatmc::coverage
