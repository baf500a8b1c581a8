// The controller of the loop that a record was measured in.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "core/base/error.h"
#include "core/record/record.h"

namespace fatmc::cli {

/// K of u = K (r - y), n_in x n_out: `gain` (--gain) times the identity, else controller_gain of the record's
/// TOML. `file` names the record in the error.
Result<Eigen::MatrixXd> loop_controller(const Record& record, const std::optional<double>& gain,
                                        const std::string& file);

}  // namespace fatmc::cli
