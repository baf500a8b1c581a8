// From records to an identified model and how well it repeats maneuvers: the work of `fatmc identify`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/subspace/discrete_model.h"
#include "core/subspace/maneuvers.h"
#include "core/subspace/model_fit.h"
#include "core/subspace/pbsid_opt.h"

namespace fatmc::cli {

struct IdentifyArguments {
  std::vector<std::string> records, validation;
  std::string meta;  ///< TOML of all records; empty: beside each
  PbsidOptions pbsid;
  Continuation continuation = Continuation::zoh;
  OffsetRemoval offset = OffsetRemoval::mean;
  double hold_back = 0.0;  ///< share at the end of each record that is kept for validation
  int decimation = 1;
  std::string directory;
};

/// One output of one maneuver.
struct OutputScore {
  std::string output;
  double variance_accounted_for = 0.0, rms = 0.0;
  std::optional<double> theil, agreement;
};

struct ManeuverScore {
  std::string name;  ///< of the record, "(held back)" behind it where it is the end of one
  std::vector<OutputScore> outputs;
  double rms = 0.0;                         ///< over all outputs
  std::optional<double> overall_agreement;  ///< H (11), weights 1
  std::string failure;                      ///< why the model could not be judged; scores are empty then
};

struct IdentifiedRecords {
  std::vector<std::string> inputs, outputs;
  double rate_hz = 0.0;  ///< after decimation
  Eigen::Index samples = 0;
  PbsidModel model;
  std::optional<ContinuousModel> continuous;
  std::string continuous_failure;  ///< why there is none
  std::vector<ManeuverScore> identification, validation;
};

/// Reads, decimates, removes offsets, identifies and validates. The error names the file or option to change.
Result<IdentifiedRecords> identify_records(const IdentifyArguments& arguments);

}  // namespace fatmc::cli
