// What `fatmc design` says of an experiment: its signals, how they go together, and the input SNR to expect.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/ident/lpm_grid.h"
#include "core/signal/phase_correlation.h"

namespace fatmc::cli {

struct DesignOptions {
  int n_e = 9;
  int order = 2;
  double relative_bias = 0.0857;
  std::optional<double> spacing_hz;
  std::int64_t seed = 0;
};

struct AxisDesign {
  int lines = 0;
  double rms = 0.0, peak = 0.0, crest_factor = 0.0;  ///< rad/s (open loop: normalised commands)
  std::vector<double> frequency_hz;
  std::vector<double> insensitivity_db;  ///< 20 log10 S of (5.9), line by line
  std::vector<double> snr_db;            ///< (5.9); empty in calm air or open loop
};

struct DesignedExperiment {
  LpmGrid grid;
  double period_s = 0.0;
  int periods = 0;
  bool zippered = false;
  std::array<AxisDesign, 3> axes;
  /// roll-pitch, roll-yaw, pitch-yaw; none for zippered lines, which nothing correlates.
  std::optional<std::array<PhaseCorrelation, 3>> correlation;
};

/// Signals of repetition 0 as `fatmc simulate --seed` flies them.
Result<DesignedExperiment> design_experiment(const std::string& experiment, const std::string& model,
                                             const DesignOptions& options);
nlohmann::ordered_json experiment_json(const DesignedExperiment& design);
void print_experiment(const DesignedExperiment& design);

}  // namespace fatmc::cli
