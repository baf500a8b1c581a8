// A model file of kind "aircraft": the aircraft and the gyros that may fly on it.
//
// docs of every key: campaigns/models/fat.toml. Angles that pilots read are in degrees there, as their names
// say.
#pragma once

#include <string_view>
#include <vector>

#include "campaigns/base/tree.h"
#include "core/base/error.h"
#include "core/flight/aircraft.h"
#include "core/flight/imu.h"

namespace fatmc {

struct AircraftModel {
  Aircraft aircraft;
  std::vector<Imu> imus;  ///< by grade, in the order of the file

  /// The gyros of that grade, or null.
  [[nodiscard]] const Imu* imu(std::string_view grade) const;
};

/// Reads the whole tree of a model file strictly: every key, type and range is checked, unknown keys are
/// refused.
Result<AircraftModel> decode_aircraft_model(const Tree& tree);

}  // namespace fatmc
