// One quantity of a study: a value a line and run, with its quantiles over runs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "campaigns/base/figure.h"

namespace fatmc {

class LineRuns {
 public:
  /// The next run, one value a line; equally many each time, no NaN.
  void add(std::span<const double> run);

  [[nodiscard]] std::size_t lines() const { return values_.size(); }
  [[nodiscard]] std::size_t runs() const { return values_.empty() ? 0 : values_.front().size(); }
  /// Runs of one line, in the order in which they came.
  [[nodiscard]] std::span<const double> line(std::size_t k) const { return values_[k]; }

  /// Quantile of a line over all runs (type 7).
  [[nodiscard]] double quantile(std::size_t k, double p) const;
  /// Share of the runs picked with a value above (below) `limit`, in [0, 1].
  [[nodiscard]] double share_above(std::size_t k, double limit, std::span<const std::size_t> picks) const;

 private:
  std::vector<std::vector<double>> values_;  // line by line
};

/// How often each run was picked (core/stats/bootstrap.h).
struct RunCounts {
  RunCounts(std::size_t runs, std::span<const std::size_t> picks);
  std::vector<std::uint32_t> of_run;
  std::size_t total = 0;
};

/// Quantiles of resampled runs: each line's runs are sorted once, a resample then costs a walk over its counts.
class SortedRuns {
 public:
  explicit SortedRuns(const LineRuns& values);
  /// Of line k over the runs as often as they were picked (type 7); picks may not be empty.
  [[nodiscard]] double quantile(std::size_t k, double p, const RunCounts& counts) const;
  [[nodiscard]] std::size_t runs() const { return runs_; }

 private:
  struct Entry {
    double value;
    std::uint32_t run;
  };
  std::size_t runs_ = 0;
  std::vector<std::vector<Entry>> lines_;
};

/// Index of the line nearest to a frequency; of two equally near the lower.
std::size_t nearest_line(std::span<const double> frequency_hz, double hz);

/// A box a line at x[k].
plot::Boxes boxes_of(const LineRuns& values, std::vector<double> x);
/// Median over the runs of every line.
std::vector<double> medians_of(const LineRuns& values);

}  // namespace fatmc
