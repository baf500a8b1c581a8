#include "campaigns/coverage/covered_runs.h"

#include <cmath>
#include <complex>

#include "campaigns/coverage/row_arrays.h"

namespace fatmc::coverage {
namespace {

TrialErrors read_errors(const TrialRow& row) {
  const auto& re = array_of(row, kErrorReal);
  const auto& im = array_of(row, kErrorImag);
  TrialErrors out;
  out.error.reserve(re.size());
  for (std::size_t i = 0; i < re.size(); ++i) out.error.emplace_back(re[i], im[i]);
  out.variance = array_of(row, kVariance);
  out.bias = array_of(row, kBias);
  if (const auto* printed = row.array(kBiasPrinted)) out.bias_printed = *printed;
  return out;
}

void count_inside(const TrialErrors& errors, std::size_t elements, int q, Region region, CoveredRuns& out) {
  for (std::size_t level = 0; level < kLevels.size(); ++level) {
    const TrialCoverage coverage = trial_coverage(errors, region, kLevels[level], elements, q);
    out.shares[{region, level, CoveredRuns::Scope::element}].push_back(coverage.element);
    out.shares[{region, level, CoveredRuns::Scope::joint}].push_back(coverage.joint);
    out.shares[{region, level, CoveredRuns::Scope::bonferroni}].push_back(coverage.bonferroni);
  }
  std::array<std::uint64_t, kCdfAbscissae.size()> below{};
  for (std::size_t i = 0; i < errors.error.size(); ++i) {
    const double square = normalised_square(errors, region, i);
    for (std::size_t x = 0; x < kCdfAbscissae.size(); ++x) below[x] += square <= kCdfAbscissae[x] ? 1 : 0;
  }
  for (std::size_t x = 0; x < kCdfAbscissae.size(); ++x) {
    out.cdf[{region, x}].push_back(static_cast<double>(below[x]) / static_cast<double>(errors.error.size()));
  }
}

}  // namespace

void for_each_run(std::uint32_t cell, const RowSource& rows,
                  const std::function<void(const TrialRow&, const TrialErrors&)>& visit) {
  // First pass: the sample mean of the errors, for the error against the mean.
  std::vector<std::complex<double>> mean;
  std::uint64_t n = 0;
  rows(cell, [&](const TrialRow& row) {
    if (row.outcome != "ok") return;
    const auto& re = array_of(row, kErrorReal);
    const auto& im = array_of(row, kErrorImag);
    mean.resize(re.size());
    for (std::size_t i = 0; i < re.size(); ++i) mean[i] += std::complex<double>(re[i], im[i]);
    ++n;
  });
  if (n == 0) return;
  for (auto& value : mean) value /= static_cast<double>(n);
  const double inflate = n > 1 ? std::sqrt(static_cast<double>(n) / static_cast<double>(n - 1)) : 0.0;
  rows(cell, [&](const TrialRow& row) {
    if (row.outcome != "ok") return;
    TrialErrors errors = read_errors(row);
    for (std::size_t i = 0; n > 1 && i < mean.size(); ++i)
      errors.sample_error.push_back((errors.error[i] - mean[i]) * inflate);
    visit(row, errors);
  });
}

CoveredRuns covered_runs(std::uint32_t cell, const RowSource& rows) {
  CoveredRuns out;
  rows(cell, [&](const TrialRow& row) {
    ++out.trials;
    out.failed += row.outcome != "ok" ? 1 : 0;
  });
  for_each_run(cell, rows, [&](const TrialRow& row, const TrialErrors& errors) {
    const auto elements = static_cast<std::size_t>(metric_of(row, kElements));
    out.degrees_of_freedom = static_cast<int>(metric_of(row, kDegreesOfFreedom));
    for (const Region region : kRegions) {
      if (region == Region::sample && errors.sample_error.empty()) continue;
      if (needs_printed_constant(region) && errors.bias_printed.empty()) continue;
      count_inside(errors, elements, out.degrees_of_freedom, region, out);
    }
    out.snr.add(array_of(row, kInputSnr), static_cast<std::size_t>(metric_of(row, kInputs)));
  });
  for (auto& [key, values] : out.shares) values.resize(out.trials, 0.0);
  for (auto& [key, values] : out.cdf) values.resize(out.trials, 0.0);
  return out;
}

}  // namespace fatmc::coverage
