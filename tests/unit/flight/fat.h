// The FAT as the repository ships it, for tests.
#pragma once

#include "campaigns/base/aircraft_model.h"
#include "coordinator/input/toml_file.h"
#include "core/base/check.h"

namespace fatmc {

inline const AircraftModel& fat_model() {
  static const AircraftModel model = [] {
    const Result<Tree> tree = read_toml("campaigns/models/fat.toml");
    FATMC_CHECK(tree.has_value(), "tests run in the project's directory");
    const Result<AircraftModel> decoded = decode_aircraft_model(*tree);
    FATMC_CHECK(decoded.has_value(), "fat.toml is valid");
    return *decoded;
  }();
  return model;
}
inline const Aircraft& fat() { return fat_model().aircraft; }

}  // namespace fatmc
