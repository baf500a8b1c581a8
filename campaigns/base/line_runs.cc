#include "campaigns/base/line_runs.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/check.h"
#include "core/stats/empirical.h"

namespace fatmc {

std::size_t nearest_line(std::span<const double> frequency_hz, double hz) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < frequency_hz.size(); ++k) {
    if (std::abs(frequency_hz[k] - hz) < std::abs(frequency_hz[best] - hz)) best = k;
  }
  return best;
}

void LineRuns::add(std::span<const double> run) {
  if (values_.empty()) values_.resize(run.size());
  FATMC_CHECK(run.size() == values_.size(), "as many lines in every run");
  for (std::size_t k = 0; k < run.size(); ++k) values_[k].push_back(run[k]);
}

double LineRuns::quantile(std::size_t k, double p) const {
  std::vector<double> scratch(values_[k]);
  return sample_quantile(scratch, p);
}

double LineRuns::share_above(std::size_t k, double limit, std::span<const std::size_t> picks) const {
  std::size_t above = 0;
  for (const std::size_t run : picks) above += values_[k][run] > limit ? 1 : 0;
  return static_cast<double>(above) / static_cast<double>(picks.size());
}

RunCounts::RunCounts(std::size_t runs, std::span<const std::size_t> picks)
    : of_run(runs, 0), total(picks.size()) {
  for (const std::size_t run : picks) ++of_run[run];
}

SortedRuns::SortedRuns(const LineRuns& values) : runs_(values.runs()) {
  for (std::size_t k = 0; k < values.lines(); ++k) {
    std::vector<Entry>& line = lines_.emplace_back();
    for (std::size_t run = 0; run < runs_; ++run)
      line.push_back({values.line(k)[run], static_cast<std::uint32_t>(run)});
    std::stable_sort(line.begin(), line.end(),
                     [](const Entry& a, const Entry& b) { return a.value < b.value; });
  }
}

double SortedRuns::quantile(std::size_t k, double p, const RunCounts& counts) const {
  FATMC_CHECK(counts.total > 0 && counts.of_run.size() == runs_, "picks of these runs");
  const double h = p * static_cast<double>(counts.total - 1);
  const auto below = static_cast<std::size_t>(h);
  const double share = h - static_cast<double>(below);
  std::size_t passed = 0;
  const std::vector<Entry>& line = lines_[k];
  auto at = line.begin();
  while ((passed += counts.of_run[at->run]) <= below) ++at;
  const double value = at->value;
  if (share == 0.0 || passed > below + 1) return value;
  do ++at;
  while (counts.of_run[at->run] == 0);
  return value == at->value ? value
                            : value + share * (at->value - value);  // equal infinities have no difference
}

plot::Boxes boxes_of(const LineRuns& values, std::vector<double> x) {
  FATMC_CHECK(x.size() == values.lines(), "an abscissa a line");
  plot::Boxes out;
  for (std::size_t k = 0; k < values.lines(); ++k) {
    const auto line = values.line(k);
    if (auto box = plot::box_of({line.begin(), line.end()})) {
      out.x.push_back(x[k]);
      out.boxes.push_back(std::move(*box));
    }
  }
  return out;
}

std::vector<double> medians_of(const LineRuns& values) {
  std::vector<double> out;
  for (std::size_t k = 0; k < values.lines(); ++k) out.push_back(values.quantile(k, 0.5));
  return out;
}

}  // namespace fatmc
