// What an estimator is given: one experiment's samples, and options that hold for all methods.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/ident/frm_estimate.h"
#include "core/ident/lpm_grid.h"

namespace fatmc {

struct Measurement {
  PeriodicExperiment experiment;  ///< periods and lines 0 and empty for an aperiodic record; rate_hz always
  Eigen::MatrixXd outputs;        ///< samples x n_out
  Eigen::MatrixXd inputs;         ///< samples x n_in
  Eigen::MatrixXd references;     ///< samples x n_in (indirect) or samples x 0 (direct)
  double low_hz = 0.0;            ///< band of the estimate, for methods that take any bin
  double high_hz = std::numeric_limits<double>::infinity();

  [[nodiscard]] int n_out() const { return static_cast<int>(outputs.cols()); }
  [[nodiscard]] int n_in() const { return static_cast<int>(inputs.cols()); }
  [[nodiscard]] bool indirect() const { return references.cols() > 0; }
};

/// A response, and what the method alone knows of it.
struct ResponseEstimate {
  FrmEstimate frm;
  MatrixStack<double> bias;       ///< n_out x n_in a line; empty where the method has no estimate of its bias
  MatrixStack<double> coherence;  ///< n_out x 1 a line, multiple coherence; empty for methods without one
  std::optional<LpmGrid> grid;    ///< windows behind a fast LPM estimate; none for other methods
  std::vector<int> fallback;      ///< lines (harmonics) where a simpler method stepped in
  std::vector<std::string> notes; ///< one sentence each, for the reader of the result
};

}  // namespace fatmc
