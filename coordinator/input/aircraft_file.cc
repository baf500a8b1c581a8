#include "coordinator/input/aircraft_file.h"

#include "campaigns/base/aircraft_model.h"
#include "coordinator/input/toml_file.h"
#include "core/base/text.h"

namespace fatmc {

Result<TrimmedAircraft> read_trimmed_aircraft(const std::string& path) {
  const Result<Tree> tree = read_toml(path);
  if (!tree) return fail(tree.error());
  return decode_trimmed_aircraft(*tree, path);
}

Result<TrimmedAircraft> decode_trimmed_aircraft(const Tree& tree, const std::string& path) {
  Result<AircraftModel> model = decode_aircraft_model(tree);
  if (!model) return fail(model.error());
  const Result<ModifiedFlight> modified = modified_flight(*model, FlightSetup{});
  if (!modified) return fail(Error{path, 0, modified.error().key, modified.error().message});
  const Trim trim = trim_level(modified->aircraft);
  if (!trim.usable()) {
    return fail(Error{path, 0, "trim.speed_m_s",
                      trim.outcome == Trim::Outcome::outside_model
                          ? "level flight there needs more than throttle, elevator or angle of attack allow"
                          : "no level flight found: residual " + significant(trim.residual, 3) + " after " +
                                std::to_string(trim.iterations) + " iterations"});
  }
  TrimmedAircraft out{modified->aircraft, trim, {}};
  for (const Effect& effect : model->effects) {
    if (!effect.kind().in_linear_airframe || effect.onset) out.not_linear.push_back(effect.text());
  }
  return out;
}

}  // namespace fatmc
