// Records as maneuvers for identification: those that a model is made of, and those that it has to repeat.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/subspace/discrete_model.h"
#include "core/subspace/maneuvers.h"

namespace fatmc::cli {

/// Which records, and how they are cut and prepared.
struct RecordSelection {
  std::vector<std::string> records, validation;
  std::string meta;  ///< TOML of all records; empty: beside each
  OffsetRemoval offset = OffsetRemoval::mean;
  double hold_back = 0.0;  ///< share at the end of each record that is kept for validation
  int decimation = 1;
  std::vector<double> weights;  ///< w_i of the overall d1, H (11), by output; none: 1 each
};

/// record..., --validate, --hold-back, --meta, --offset, --decimate, --weights.
void add_record_options(CLI::App& command, RecordSelection& selection);

struct NamedManeuver {
  std::string name;  ///< of the record, "(held back)" behind it where it is the end of one
  Maneuver maneuver;
};

struct RecordManeuvers {
  std::vector<NamedManeuver> identification, validation;
  std::vector<std::string> inputs, outputs;
  double rate_hz = 0.0;  ///< after decimation

  /// Those of the identification or of the validation alone, in order.
  [[nodiscard]] std::vector<Maneuver> data() const;
  [[nodiscard]] std::vector<Maneuver> validation_data() const;
};

/// Reads, decimates, cuts and removes offsets. The error names the file or option to change.
Result<RecordManeuvers> read_maneuvers(const RecordSelection& selection);

/// One output of one maneuver.
struct OutputScore {
  std::string output;
  double variance_accounted_for = 0.0, rms = 0.0;
  std::optional<double> theil, agreement;
};

struct ManeuverScore {
  std::string name;
  std::vector<OutputScore> outputs;
  double rms = 0.0;                         ///< over all outputs
  std::optional<double> overall_agreement;  ///< H (11)
  std::string failure;                      ///< why the model could not be judged; scores are empty then
  Eigen::MatrixXd simulated;                ///< samples x n_y
};

/// How well the model repeats the maneuver, initial state and offsets fitted (model_fit.h).
ManeuverScore score(const NamedManeuver& maneuver, const std::vector<std::string>& outputs,
                    const DiscreteModel& model, std::span<const double> weights = {});

}  // namespace fatmc::cli
