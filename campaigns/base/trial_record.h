// The channels of a flight behind a row.
#pragma once

#include <string>
#include <vector>

#include "campaigns/base/experiment.h"
#include "core/flight/flight.h"

namespace fatmc {

struct TrialRecord {
  std::vector<std::string> names;  ///< "t", "r_p", ...
  Eigen::MatrixXd columns;         ///< samples by names; SI and rad
  std::string toml;                ///< what each column is (docs/records.md)
};

/// t, references, inputs, outputs, phi, theta and V of a flight; after a divergence up to its end.
TrialRecord trial_record(const FlightRecord& flown, const Experiment& experiment, const Aircraft& aircraft);

}  // namespace fatmc
