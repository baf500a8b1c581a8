// A model file of kind "aircraft": the aircraft, the gyros that may fly on it, and effects that it is patched with.
//
// docs of every key: campaigns/models/fat.toml. Angles that pilots read are in degrees there, as their names
// say.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "campaigns/base/tree.h"
#include "core/base/error.h"
#include "core/flight/aircraft.h"
#include "core/flight/effects/effect.h"
#include "core/flight/imu.h"

namespace fatmc {

struct AircraftModel {
  Aircraft aircraft;  ///< without the effects
  std::vector<Effect>
      effects;            ///< [[effect]], in the order of the file; removing the tables gives the parent
  std::vector<Imu> imus;  ///< by grade, in the order of the file

  /// The gyros of that grade, or null.
  [[nodiscard]] const Imu* imu(std::string_view grade) const;
};

/// Aircraft and setup as they are flown: with the model's effects and further ones.
Result<ModifiedFlight> modified_flight(const AircraftModel& model, const FlightSetup& setup,
                                       std::span<const Effect> further = {});
/// The same, ready to fly.
Result<Flight> prepare_flight(const AircraftModel& model, const FlightSetup& setup,
                              std::span<const Effect> further = {});

/// Reads the whole tree of a model file strictly: every key, type and range is checked, unknown keys are
/// refused.
Result<AircraftModel> decode_aircraft_model(const Tree& tree);

}  // namespace fatmc
