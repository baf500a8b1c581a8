// Whether a record can be what it says: units, saturation.
#pragma once

#include <string>

#include "core/discrepancy/loop_record.h"
#include "core/discrepancy/model_simulator.h"

namespace fatmc::cli {

/// From the record alone: commands that follow u = K (r - y) with a K that is off by 57.3 or 9.81, attitude in other units
/// than the rates, a channel that stands at its end.
Status check_plausible(const LoopRecord& record, const FlightSetup& setup, double rate_hz,
                       const std::string& file);

/// Against one flight of the model on the record's reference: outputs that are off by 57.3 or 9.81 throughout.
Status check_against_model(const LoopRecord& record, const ModelSimulator& model, const std::string& file);

}  // namespace fatmc::cli
