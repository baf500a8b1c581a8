#include "core/stats/bootstrap.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "core/random/random_stream.h"
#include "core/stats/empirical.h"

namespace fatmc {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class Resampling {
 public:
  Resampling(std::size_t n, const RunStatistic& statistic, std::uint64_t seed)
      : n_(n), statistic_(statistic), random_(TrialSeed{seed, name_hash("bootstrap"), 0, 0}, "bootstrap") {}

  double draw(std::size_t count) {
    picks_.resize(count);
    for (std::size_t& pick : picks_)
      pick = static_cast<std::size_t>(random_.uniform() * static_cast<double>(n_));
    return statistic_(picks_);
  }
  [[nodiscard]] double whole() {
    picks_.resize(n_);
    std::iota(picks_.begin(), picks_.end(), std::size_t{0});
    return statistic_(picks_);
  }

 private:
  std::size_t n_;
  const RunStatistic& statistic_;
  RandomStream random_;
  std::vector<std::size_t> picks_;
};

template <typename Draw>
Interval quantiles(const Bootstrap& options, Draw draw) {
  std::vector<double> values;
  for (std::uint64_t k = 0; k < options.resamples; ++k) {
    const double value = draw();
    if (std::isfinite(value)) values.push_back(value);
  }
  if (values.empty() || 2 * values.size() < options.resamples) return {-kInfinity, kInfinity};
  const EmpiricalCdf cdf(std::move(values));
  const double tail = (1.0 - options.level) / 2.0;
  return {cdf.quantile(tail), cdf.quantile(1.0 - tail)};
}

}  // namespace

Interval bootstrap_interval(std::size_t n, const RunStatistic& statistic, const Bootstrap& options) {
  if (n < 2) return {-kInfinity, kInfinity};
  Resampling runs(n, statistic, options.seed);
  const double whole = runs.whole();
  return quantiles(options, [&] { return 2.0 * whole - runs.draw(n); });
}

Interval bootstrap_prediction(std::size_t n, std::size_t m, const RunStatistic& statistic,
                              const Bootstrap& options) {
  if (n < 2 || m < 1) return {-kInfinity, kInfinity};
  Resampling runs(n, statistic, options.seed);
  const double whole = runs.whole();
  return quantiles(options, [&] {
    const double theirs = runs.draw(m);
    return theirs + (whole - runs.draw(n));
  });
}

}  // namespace fatmc
