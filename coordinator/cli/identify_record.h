// From records to an identified model and how well it repeats maneuvers: the work of `fatmc identify`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "coordinator/cli/record_maneuvers.h"
#include "core/base/error.h"
#include "core/subspace/discrete_model.h"
#include "core/subspace/pbsid_opt.h"

namespace fatmc::cli {

struct IdentifyArguments : RecordSelection {
  PbsidOptions pbsid;
  Continuation continuation = Continuation::zoh;
  std::string directory;
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
