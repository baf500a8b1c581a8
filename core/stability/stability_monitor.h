// Confident stability level over a moving window (T section 5.7): samples in, a judgement whenever it is
// asked for.
//
// The window is the whole record of an estimate, P periods; it moves sample by sample. Its spectra come from
// a sliding DFT at the bins that the estimate reads, references included, so that no phase has to be known: a
// window that begins anywhere in the period has the references' phase of that place. Judgement as in
// estimate_stability.h, every line's scaling of the structured singular value starting from the last epoch's.
//
// Until the window is full its beginning is zeros (T Fig. 5-16): p does not describe the aircraft then;
// Epoch::window_full says so. A line whose references are still missing has no estimate and p = 0.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/ident/fast_lpm.h"
#include "core/ident/interpolation_bias.h"
#include "core/signal/sliding_dft.h"
#include "core/stability/estimate_stability.h"

namespace fatmc {

struct MonitorEpoch {
  std::int64_t samples = 0;  ///< seen so far; the newest is samples - 1
  bool window_full = false;
  BandStability band;
};

class StabilityMonitor {
 public:
  /// `nominal` has one response a line of the grid. `constant` of the interpolation bias, where the options count it.
  StabilityMonitor(const LpmGrid& grid, int n_out, NominalLoop nominal, const StabilityOptions& options,
                   BiasConstant constant = BiasConstant::exact_offsets);

  /// One sample: n_out outputs, n_in inputs, n_in references.
  void push(std::span<const double> outputs, std::span<const double> inputs,
            std::span<const double> references);
  /// Judges the window as it stands. Deterministic in the samples and in the epochs asked for before (warm
  /// starts move the bounds of ssv within the accuracy that SsvBounds states).
  MonitorEpoch epoch();
  /// The estimate of the last epoch.
  [[nodiscard]] const FrmEstimate& estimate() const { return *estimate_; }

 private:
  LpmGrid grid_;
  int n_out_;
  NominalLoop nominal_;
  StabilityOptions options_;
  BiasConstant constant_;
  FastLpm lpm_;
  SlidingDft measured_;    ///< outputs and inputs at all bins of the estimate
  SlidingDft references_;  ///< at the excited bins
  std::vector<double> sample_;
  Eigen::MatrixXcd spectra_;    ///< bin_count x (n_out + n_in); rows that nobody reads stay zero
  Eigen::MatrixXcd reference_;  ///< line_count x n_in
  EstimateScalings scalings_;
  const FrmEstimate* estimate_ = nullptr;
};

}  // namespace fatmc
