// An aircraft and its level flight, from a model file of kind "aircraft".
#pragma once

#include <string>
#include <vector>

#include "campaigns/base/tree.h"
#include "core/base/error.h"
#include "core/flight/aircraft.h"
#include "core/flight/trim.h"

namespace fatmc {

struct TrimmedAircraft {
  Aircraft aircraft;  ///< with the effects of the model
  Trim trim;          ///< usable
  /// Effects of the model that the linearised airframe does not show: delays and lags in the signal path, modes with states of
  /// their own, what vanishes for small motions, what changes in flight.
  std::vector<std::string> not_linear;
};

/// The error names the key that is wrong, or says why there is no level flight at the model's speed.
Result<TrimmedAircraft> read_trimmed_aircraft(const std::string& path);
/// The same from a file that has been parsed.
Result<TrimmedAircraft> decode_trimmed_aircraft(const Tree& tree, const std::string& path);

}  // namespace fatmc
