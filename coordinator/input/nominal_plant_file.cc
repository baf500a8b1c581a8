#include "coordinator/input/nominal_plant_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>

#include "campaigns/base/decoder.h"
#include "coordinator/input/aircraft_file.h"
#include "coordinator/input/response_file.h"
#include "coordinator/input/state_space_model.h"
#include "coordinator/input/toml_file.h"
#include "core/base/text.h"
#include "core/flight/linear_model.h"
#include "core/flight/step_parts.h"

namespace fatmc {
namespace {

RecordChannels channels_of(const MeasuredLoop& measured) {
  return {measured.inputs, measured.outputs, measured.rate_hz, measured.hold};
}

constexpr double kIntegratorRounding = 1e-6;  // an integrator's pole, as others may have written it
constexpr double kLongestStep = 0.02;         // s, of the Runge-Kutta steps that the aircraft is flown with (T 3.2)

Result<NamedModel> aircraft_model(const Tree& tree, const std::string& path, const MeasuredLoop& measured,
                                  std::vector<std::string>& not_shown) {
  if (measured.hold != Hold::zoh) {
    return fail(Error{path, 0, "kind", "an aircraft is sampled with held commands, the record's hold is \"continuous\": "
                                       "give its response as kind = \"frf\""});
  }
  const Result<TrimmedAircraft> trimmed = decode_trimmed_aircraft(tree, path);
  if (!trimmed) return fail(trimmed.error());
  not_shown = trimmed->not_linear;
  const double tick_s = 1.0 / measured.rate_hz;
  const int whole = std::max(1, static_cast<int>(std::ceil(tick_s / kLongestStep - 1e-9)));
  const int steps =
      whole * parts_of_step(trimmed->aircraft, linearize(trimmed->aircraft, trimmed->trim), tick_s / whole);
  const LinearModel linear = sample(trimmed->aircraft, trimmed->trim, tick_s, steps);
  NamedModel out{{linear.a, linear.b, linear.c, linear.d}, {}, {}};
  out.inputs.assign(kInputNames.begin(), kInputNames.end());
  out.outputs.assign(kOutputNames.begin(), kOutputNames.end());
  return out;
}

/// Stability with and without K, then the responses.
Result<NominalPlant> stable_plant(const NamedModel& named, const std::string& kind, const MeasuredLoop& measured,
                                  const std::string& path) {
  const Result<SampledModel> model = pick_channels(named, channels_of(measured), path);
  if (!model) return fail(model.error());
  const std::optional<StabilisedModel> stable = stabilise(*model);
  if (!stable) return fail(Error{path, 0, "A", "its eigenvalues cannot be computed"});
  if (kind != "aircraft" && stable->largest_modulus > 1.0 + kIntegratorRounding) {
    return fail(Error{path, 0, "A", "the nominal model is not stable: a pole has modulus " +
                                        significant(stable->largest_modulus, 8) +
                                        "; robust stability is carried over from a stable model"});
  }
  const std::optional<double> closed = closed_loop_radius(stable->model, measured.controller);
  if (!closed) {
    return fail(Error{path, 0, "D", "I + K D is singular: the loop with this controller gain does not exist"});
  }
  if (!(*closed < 1.0)) {
    return fail(Error{path, 0, "", "the nominal model with the controller gain is not stable: a pole of the closed loop has "
                                   "modulus " + significant(*closed, 8) + "; check the gain and its sign (u = K (r - y))"});
  }
  NominalPlant out;
  out.kind = kind;
  out.loop = nominal_loop(stable->model, measured.controller, measured.frequency_hz, measured.rate_hz);
  out.moved_poles = stable->moved_poles;
  out.largest_pole = stable->largest_modulus;
  out.largest_closed_loop_pole = *closed;
  return out;
}

Result<NominalPlant> response_plant(const std::string& csv, bool diagonal, const MeasuredLoop& measured) {
  const Result<ResponseTable> table = read_response_table(csv);
  if (!table) return fail(table.error());
  const auto inputs = channel_places(measured.inputs, table->inputs, "input", csv);
  if (!inputs) return fail(inputs.error());
  const auto outputs = channel_places(measured.outputs, table->outputs, "output", csv);
  if (!outputs) return fail(outputs.error());
  NominalPlant out;
  out.kind = "frf";
  out.loop.controller = measured.controller.cast<std::complex<double>>();
  out.loop.response.resize(static_cast<int>(outputs->size()), static_cast<int>(inputs->size()),
                           static_cast<int>(measured.frequency_hz.size()));
  for (int k = 0; k < out.loop.response.count(); ++k) {
    const double f = measured.frequency_hz[static_cast<std::size_t>(k)];
    const auto at = std::lower_bound(table->frequency_hz.begin(), table->frequency_hz.end(), f * (1.0 - 1e-6));
    if (at == table->frequency_hz.end() || *at > f * (1.0 + 1e-6)) {
      return fail(Error{csv, 0, "frequency_hz", "has no response at " + significant(f, 7) +
                                                    " Hz, a line of the record: a nominal response needs all of them"});
    }
    out.loop.response[k] = table->response[static_cast<int>(at - table->frequency_hz.begin())](*outputs, *inputs);
    for (std::size_t i = 0; diagonal && i < outputs->size(); ++i) {
      for (std::size_t j = 0; j < inputs->size(); ++j) {
        if ((*outputs)[i] != (*inputs)[j]) out.loop.response[k](static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = 0.0;
      }
    }
  }
  return out;
}

}  // namespace

Result<NominalPlant> read_nominal_plant(const std::string& path, const MeasuredLoop& measured) {
  const std::filesystem::path named(path);
  if (named.extension() == ".csv") return response_plant(path, false, measured);
  const Result<Tree> tree = read_toml(path);
  if (!tree) return fail(tree.error());
  Decoder kinds(*tree, "");
  const std::string kind = kinds.choice("kind", {"aircraft", "state_space", "frf"});
  if (kinds.error()) return fail(*kinds.error());
  if (kind == "frf") {
    Decoder table(*tree, "");
    table.text("kind");
    const std::string file = table.text("response");
    const bool diagonal = table.choice("elements", {"all", "diagonal"}, "all") == "diagonal";
    table.skip("band_hz");  // of diagnose
    if (Status status = table.finish(); !status) return fail(status.error());
    return response_plant((named.parent_path() / file).string(), diagonal, measured);
  }
  std::vector<std::string> not_shown;
  const Result<NamedModel> model =
      kind == "aircraft" ? aircraft_model(*tree, path, measured, not_shown) : decode_state_space(*tree, channels_of(measured));
  if (!model) return fail(model.error());
  Result<NominalPlant> plant = stable_plant(*model, kind, measured, path);
  if (plant) plant->effects_not_shown = std::move(not_shown);
  return plant;
}

std::string effects_not_shown(const NominalPlant& nominal, const std::string& path) {
  if (nominal.effects_not_shown.empty()) return "";
  return path + ": not in the nominal plant: " + join(nominal.effects_not_shown) +
         " (what is judged is the loop around the airframe without; fatmc simulate flies it)";
}

}  // namespace fatmc
