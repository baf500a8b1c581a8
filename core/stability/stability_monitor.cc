#include "core/stability/stability_monitor.h"

#include <algorithm>
#include <utility>

#include "core/base/check.h"

namespace fatmc {
namespace {

std::vector<int> excited_bins(const LpmGrid& grid) {
  std::vector<int> out;
  for (int k = 0; k < grid.line_count(); ++k) out.push_back(grid.bin(k));
  return out;
}

/// Excited bins and those of the transient windows.
std::vector<int> read_bins(const LpmGrid& grid) {
  std::vector<int> out = excited_bins(grid);
  for (int k = 0; k < grid.line_count(); ++k) {
    const std::span<const int> window = grid.transient().bins(k);
    out.insert(out.end(), window.begin(), window.end());
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace

StabilityMonitor::StabilityMonitor(const LpmGrid& grid, int n_out, NominalLoop nominal,
                                   const StabilityOptions& options, BiasConstant constant)
    : grid_(grid),
      n_out_(n_out),
      nominal_(std::move(nominal)),
      options_(options),
      constant_(constant),
      lpm_(grid, n_out),
      measured_(grid.total_samples(), read_bins(grid), n_out + grid.n_in()),
      references_(grid.total_samples(), excited_bins(grid), grid.n_in()),
      sample_(static_cast<std::size_t>(n_out + grid.n_in())),
      spectra_(Eigen::MatrixXcd::Zero(grid.bin_count(), n_out + grid.n_in())),
      reference_(grid.line_count(), grid.n_in()) {
  FATMC_CHECK(nominal_.response.count() == grid.line_count(), "a nominal response for every line");
}

void StabilityMonitor::push(std::span<const double> outputs, std::span<const double> inputs,
                            std::span<const double> references) {
  FATMC_CHECK(outputs.size() + inputs.size() == sample_.size(), "a value of every output and input");
  std::copy(outputs.begin(), outputs.end(), sample_.begin());
  std::copy(inputs.begin(), inputs.end(), sample_.begin() + n_out_);
  measured_.push(sample_);
  references_.push(references);
}

MonitorEpoch StabilityMonitor::epoch() {
  measured_.spectrum_at_bins(spectra_);
  references_.spectrum(reference_);
  lpm_.load_spectra(spectra_.leftCols(n_out_), spectra_.rightCols(grid_.n_in()));
  estimate_ = &lpm_.indirect(reference_);
  const EstimateStability judged = judge_estimate(
      *estimate_, interpolation_bias(grid_, *estimate_, constant_), nominal_, options_, &scalings_);
  return {measured_.count(), measured_.full(), judged.band};
}

}  // namespace fatmc
