#include "coordinator/cli/loop_controller.h"

#include <cmath>

namespace fatmc::cli {

Result<Eigen::MatrixXd> loop_controller(const Record& record, const std::optional<double>& gain,
                                        const std::string& file) {
  if (!gain) {
    if (record.controller_gain) return *record.controller_gain;
    return fail(Error{
        file, 0, "controller_gain",
        "is missing: give the K of u = K (r - y) in the record's TOML, or --gain for K times the identity"});
  }
  if (!std::isfinite(*gain)) return fail(Error{"", 0, "--gain", "is a finite number"});
  const auto inputs = static_cast<Eigen::Index>(record.input.size());
  if (record.input.size() != record.output.size()) {
    return fail(Error{"", 0, "--gain",
                      "is K times the identity, but the record has " + std::to_string(inputs) +
                          " inputs and " + std::to_string(record.output.size()) +
                          " outputs: give controller_gain in its TOML"});
  }
  return Eigen::MatrixXd(*gain * Eigen::MatrixXd::Identity(inputs, inputs));
}

}  // namespace fatmc::cli
