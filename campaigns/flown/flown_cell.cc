#include "campaigns/flown/flown_cell.h"

#include <algorithm>

#include "campaigns/base/aircraft_model.h"
#include "campaigns/base/decoder.h"

namespace fatmc {
namespace {

Status apply_overrides(const Tree& tree, std::span<const char* const> own_keys, Experiment& experiment) {
  Decoder table(tree, "cell");
  for (const char* key : {"name", "repetitions"}) table.skip(key);
  for (const char* key : own_keys) table.skip(key);
  table.boolean("compare", true);  // read by the summary
  FlightSetup& flight = experiment.flight;
  if (table.has("plant")) {
    flight.plant = table.choice("plant", {"nonlinear", "linear"}) == "linear" ? FlightSetup::Plant::linear
                                                                              : FlightSetup::Plant::nonlinear;
  }
  flight.turbulence_m_s =
      table.real("turbulence_sigma_m_s", {.low = 0.0, .high = 20.0}, flight.turbulence_m_s);
  flight.step_s = table.real("rk4_step_s", {.low = 1e-5, .high = 0.1}, flight.step_s);
  flight.turn_coordinator = table.boolean("turn_coordinator", flight.turn_coordinator);
  flight.gusts_from_calm = table.boolean("gusts_from_calm", flight.gusts_from_calm);
  if (table.has("amplitude_rad_s")) {
    const std::vector<double> amplitude = table.reals("amplitude_rad_s", 3, {.low = 0.0, .high = 10.0});
    std::copy(amplitude.begin(), amplitude.end(), experiment.excitation.amplitude_rad_s.begin());
  }
  const bool other_lines = table.has("ranges_hz");
  if (other_lines) experiment.excitation.ranges = decode_ranges(table, "ranges_hz");
  if (Status status = table.finish(); !status) return status;
  return other_lines ? resolve_excitation(experiment.excitation, flight.rate_hz, tree) : Status{};
}

Status decode_estimator(const Tree& tree, FlownCell& out) {
  Decoder table(tree, "estimator");
  out.estimator.n_e = static_cast<int>(table.integer("n_e", {.low = 1, .high = 1000}, out.estimator.n_e));
  out.estimator.order = static_cast<int>(table.integer("order", {.low = 0, .high = 10}, out.estimator.order));
  out.estimator.n_transient =
      static_cast<int>(table.integer("n_transient", {.low = 1, .high = 1000}, out.estimator.n_transient));
  out.speed_correction = table.boolean("speed_correction", out.speed_correction);
  return table.finish();
}

}  // namespace

Result<FlownCell> decode_flown_cell(const CampaignSpec& spec, std::uint32_t cell,
                                    std::span<const char* const> own_tables,
                                    std::span<const char* const> own_keys) {
  Decoder top(spec.tree, "");
  for (const char* key : {"campaign", "cell", "published"}) top.skip(key);
  for (const char* key : own_tables) top.skip(key);
  const Tree* model = top.table("model");
  const Tree* experiment = top.table("experiment");
  const Tree* estimator = top.table("estimator", false);
  if (Status status = top.finish(); !status) return fail(status.error());

  FlownCell out;
  auto aircraft = decode_aircraft_model(*model);
  if (!aircraft) return fail(aircraft.error());
  out.model = std::move(*aircraft);
  auto decoded = decode_experiment(*experiment, out.model);
  if (!decoded) return fail(decoded.error());
  out.experiment = std::move(*decoded);
  if (Status status = apply_overrides(spec.cells.at(cell).tree, own_keys, out.experiment); !status)
    return fail(status.error());
  if (estimator != nullptr) {
    if (Status status = decode_estimator(*estimator, out); !status) return fail(status.error());
  }
  return out;
}

}  // namespace fatmc
