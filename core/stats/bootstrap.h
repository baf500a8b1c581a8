// Intervals of any statistic of independent runs, by resampling whole runs: lines and elements of one run are correlated,
// and a run carries its correlation along.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "core/stats/intervals.h"

namespace fatmc {

/// The statistic of the runs picked, an index may stand more than once: `picks` is never empty. NaN where it has none.
using RunStatistic = std::function<double(std::span<const std::size_t> picks)>;

struct Bootstrap {
  std::uint64_t resamples = 1000;
  double level = 0.95;
  std::uint64_t seed = 1;  ///< of the stream "bootstrap": equal arguments give equal bits
};

/// Interval for the expected value of the statistic of n runs: the basic bootstrap,
/// 2 T - quantiles of T*, T* from n runs drawn with replacement (Davison & Hinkley 1997, 5.6).
/// n < 2: infinite. Resamples without a value are left out; infinite where fewer than half have one.
Interval bootstrap_interval(std::size_t n, const RunStatistic& statistic, const Bootstrap& options = {});

/// Interval that holds the statistic of m further runs, here a published campaign's: quantiles of
/// T + (T*_m - T) + (T - T*_n) with independent resamples of m and of n of the runs: what m runs scatter by, and what ours
/// leave unknown. A statistic that grows with the number of runs (a smallest value) keeps the bias of its own m.
/// Less than nominal for extremes, since no resample leaves the values seen.
Interval bootstrap_prediction(std::size_t n, std::size_t m, const RunStatistic& statistic,
                              const Bootstrap& options = {});

}  // namespace fatmc
