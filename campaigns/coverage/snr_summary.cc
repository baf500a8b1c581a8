#include "campaigns/coverage/snr_summary.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>

#include "campaigns/base/verdict.h"
#include "campaigns/coverage/summary.h"
#include "core/stats/empirical.h"
#include "core/stats/intervals.h"

namespace fatmc::coverage {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kInputNames[] = {"xi_c", "eta_c", "zeta_c"};

struct Estimate {
  double value = kNone, low = kNone, high = kNone;
};

// Smallest of the minima of 50 runs: the mean of that over blocks of 50, since a smallest value falls with
// the number of runs. The interval is that of the smallest of 50 draws from a normal law with the mean and
// the scatter of the runs' minima (in dB): P(min <= x) = 1 - (1 - Φ)^50.
Estimate smallest(const std::vector<double>& minima) {
  constexpr std::size_t kBlock = kPublishedRepetitions;
  std::vector<double> blocks;
  for (std::size_t first = 0; blocks.empty() || first + kBlock <= minima.size(); first += kBlock) {
    const auto begin = minima.begin() + static_cast<std::ptrdiff_t>(first);
    const auto count = static_cast<std::ptrdiff_t>(std::min(kBlock, minima.size() - first));
    blocks.push_back(*std::min_element(begin, begin + count));
  }
  Estimate out;
  out.value = mean_over_runs(blocks).mean;
  const RunMean runs = mean_over_runs(minima);
  if (runs.n < 2 || !(runs.deviation > 0.0)) return out;
  const boost::math::normal law(runs.mean, runs.deviation);
  const auto quantile = [&](double p) {
    return boost::math::quantile(law, 1.0 - std::pow(1.0 - p, 1.0 / kPublishedRepetitions));
  };
  out.low = quantile(0.025);
  out.high = quantile(0.975);
  return out;
}

// Median of one line over the runs; its standard error is that of a normal sample's median, 1.2533 s/√n.
Estimate median(const std::vector<double>& values) {
  Estimate out;
  out.value = EmpiricalCdf(values).quantile(0.5);
  RunMean runs = mean_over_runs(values);
  if (runs.n < 2) return out;
  runs.mean = out.value;
  runs.deviation *= 1.2533;
  const Interval interval = prediction_interval(runs, kPublishedRepetitions);
  out.low = interval.low;
  out.high = interval.high;
  return out;
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
  const auto append = [&](std::size_t input, const std::string& quantity, const std::string& unit,
                          const auto& fill) {
    const std::string name = inputs_ == 3 ? kInputNames[input] : "input " + std::to_string(input + 1);
    TableRow row = table_row("Section 5.2.3", name, quantity, unit);
    row.published = published_value(published, row);
    row.row += suffix;
    fill(row);
    row.n = trials;
    // alike: a ratio within a factor of two (6 dB)
    judge(row, row.unit == "dB" && std::abs(row.published - row.value) < 6.0,
          "published " + std::string(row.published > row.value ? "higher" : "lower") +
              "; aerodynamic derivatives and amplitude of the excitation are not printed");
    out.push_back(std::move(row));
  };
  for (std::size_t input = 0; input < inputs_; ++input) {
    std::vector<double> minima;
    std::vector<std::vector<double>> by_line(lines);
    std::uint64_t below = 0;
    for (const std::vector<double>& run : runs_) {
      double low = std::numeric_limits<double>::infinity();
      for (std::size_t line = 0; line < lines; ++line) {
        const double snr = run[line * inputs_ + input];
        low = std::min(low, snr);
        by_line[line].push_back(snr);
      }
      minima.push_back(low);
      below += low < 20.0 ? 1 : 0;
    }
    const auto filled = [](const Estimate& estimate) {
      return [estimate](TableRow& row) {
        row.value = estimate.value;
        row.low = estimate.low;
        row.high = estimate.high;
      };
    };
    append(input, "smallest input SNR", "dB", filled(smallest(minima)));
    Estimate low, high;
    for (const std::vector<double>& values : by_line) {
      const Estimate estimate = median(values);
      if (!(estimate.value >= low.value)) low = estimate;
      if (!(estimate.value <= high.value)) high = estimate;
    }
    append(input, "smallest median", "dB", filled(low));
    append(input, "largest median", "dB", filled(high));
    append(input, "runs with a line below 20 dB", "%",
           [&](TableRow& row) { fill_share(row, below, runs_.size(), kPublishedRepetitions); });
  }
}

}  // namespace fatmc::coverage
