// The level of turbulence that a record's noise shows.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>

#include "core/discrepancy/model_simulator.h"

namespace fatmc::cli {

/// Standard deviation of the gusts in m/s at which the model's noise (log powers of non-excited bins of p, q, r below 2.5 Hz)
/// has the record's median level; on a grid of 2^(1/16), so that records of one experiment share a basis. 0 where the record
/// is quieter than gyros in calm air.
Result<double> estimate_turbulence(
    const FlightSetup& setup, const Eigen::VectorXd& features,
    const std::function<std::unique_ptr<ModelSimulator>(const FlightSetup&)>& simulator, int threads);

}  // namespace fatmc::cli
