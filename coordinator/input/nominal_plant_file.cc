#include "coordinator/input/nominal_plant_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>

#include "campaigns/base/decoder.h"
#include "coordinator/input/aircraft_file.h"
#include "coordinator/input/response_file.h"
#include "coordinator/input/toml_file.h"
#include "core/base/text.h"
#include "core/flight/linear_model.h"
#include "core/flight/step_parts.h"

namespace fatmc {
namespace {

constexpr double kIntegratorRounding = 1e-6;  // an integrator's pole, as others may have written it
constexpr double kLongestStep = 0.02;         // s, of the Runge-Kutta steps that the aircraft is flown with (T 3.2)

/// A model with names, before the record's channels are picked.
struct NamedModel {
  SampledModel model;
  std::vector<std::string> inputs, outputs;
};

/// Where each wanted name stands among those the model has.
Result<std::vector<Eigen::Index>> pick(const std::vector<std::string>& wanted, const std::vector<std::string>& names,
                                       const std::string& role, const std::string& path) {
  std::vector<Eigen::Index> out;
  for (const std::string& name : wanted) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      return fail(Error{path, 0, role + "s",
                        "the record's " + role + " \"" + name + "\" is not among those of the model, " + join(names)});
    }
    out.push_back(found - names.begin());
  }
  return out;
}

Result<SampledModel> pick_channels(const NamedModel& named, const MeasuredLoop& measured, const std::string& path) {
  const auto inputs = pick(measured.inputs, named.inputs, "input", path);
  if (!inputs) return fail(inputs.error());
  const auto outputs = pick(measured.outputs, named.outputs, "output", path);
  if (!outputs) return fail(outputs.error());
  return SampledModel{named.model.a, named.model.b(Eigen::all, *inputs), named.model.c(*outputs, Eigen::all),
                      named.model.d(*outputs, *inputs)};
}

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

/// Rows of an entry that should be a matrix, and columns of its first row; zero where it is none.
std::pair<std::size_t, std::size_t> shape(const Tree& tree, const char* key) {
  const Tree* entry = tree.find(key);
  const Tree::Array* rows = entry != nullptr ? entry->array() : nullptr;
  if (rows == nullptr || rows->items.empty()) return {0, 0};
  const Tree::Array* first = rows->items.front().array();
  return {rows->items.size(), first != nullptr ? first->items.size() : 0};
}

Eigen::MatrixXd read_matrix(Decoder& table, const char* key, std::size_t rows, std::size_t columns) {
  const std::vector<std::vector<double>> values = table.matrix(key, rows, columns);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
  for (std::size_t i = 0; i < std::min(rows, values.size()); ++i) {
    for (std::size_t j = 0; j < std::min(columns, values[i].size()); ++j) {
      out(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = values[i][j];
    }
  }
  return out;
}

std::vector<std::string> read_names(Decoder& table, const char* key, std::size_t count,
                                    const std::vector<std::string>& record) {
  if (!table.has(key) && record.size() != count) {
    table.reject(key, "is needed: the model has " + std::to_string(count) + ", the record " + std::to_string(record.size()));
  }
  std::vector<std::string> names = table.texts(key, record);
  if (names.size() != count) {
    table.reject(key, "holds " + std::to_string(names.size()) + " names for " + std::to_string(count) + " channels");
  }
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (std::count(names.begin(), names.end(), names[k]) > 1) table.reject(key, "names \"" + names[k] + "\" twice");
  }
  return names;
}

void check_rate(Decoder& table, double record_rate_hz) {
  const bool rate_given = table.has("rate_hz"), time_given = table.has("sample_time_s");
  const double rate_hz = rate_given ? table.real("rate_hz", {.low = 1e-9, .high = 1e9}) : 0.0;
  const double time_s = time_given ? table.real("sample_time_s", {.low = 1e-9, .high = 1e9}) : 0.0;
  if (rate_given == time_given) {
    table.reject("rate_hz", "give either rate_hz or sample_time_s");
  } else if (!table.error()) {
    const double rate = rate_given ? rate_hz : 1.0 / time_s;
    if (std::abs(rate / record_rate_hz - 1.0) > 1e-6) {
      table.reject(rate_given ? "rate_hz" : "sample_time_s",
                   "the model is sampled at " + significant(rate, 8) + " Hz, the record at " + shortest(record_rate_hz) +
                       " Hz: sample the model at the record's rate");
    }
  }
}

Result<NamedModel> state_space_model(const Tree& tree, const MeasuredLoop& measured) {
  Decoder table(tree, "");
  table.text("kind");
  table.text("name", "");
  check_rate(table, measured.rate_hz);
  const std::size_t states = shape(tree, "A").first, n_in = shape(tree, "B").second, n_out = shape(tree, "C").first;
  NamedModel out;
  out.model.a = read_matrix(table, "A", states, states);
  out.model.b = read_matrix(table, "B", states, n_in);
  out.model.c = read_matrix(table, "C", n_out, states);
  out.model.d = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(n_out), static_cast<Eigen::Index>(n_in));
  if (table.has("D")) out.model.d = read_matrix(table, "D", n_out, n_in);
  if (!table.error()) {
    out.inputs = read_names(table, "inputs", n_in, measured.inputs);
    out.outputs = read_names(table, "outputs", n_out, measured.outputs);
  }
  if (Status status = table.finish(); !status) return fail(status.error());
  return out;
}

/// Stability with and without K, then the responses.
Result<NominalPlant> stable_plant(const NamedModel& named, const std::string& kind, const MeasuredLoop& measured,
                                  const std::string& path) {
  const Result<SampledModel> model = pick_channels(named, measured, path);
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

Result<NominalPlant> response_plant(const std::string& csv, const MeasuredLoop& measured) {
  const Result<ResponseTable> table = read_response_table(csv);
  if (!table) return fail(table.error());
  const auto inputs = pick(measured.inputs, table->inputs, "input", csv);
  if (!inputs) return fail(inputs.error());
  const auto outputs = pick(measured.outputs, table->outputs, "output", csv);
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
  }
  return out;
}

}  // namespace

Result<NominalPlant> read_nominal_plant(const std::string& path, const MeasuredLoop& measured) {
  const std::filesystem::path named(path);
  if (named.extension() == ".csv") return response_plant(path, measured);
  const Result<Tree> tree = read_toml(path);
  if (!tree) return fail(tree.error());
  Decoder kinds(*tree, "");
  const std::string kind = kinds.choice("kind", {"aircraft", "state_space", "frf"});
  if (kinds.error()) return fail(*kinds.error());
  if (kind == "frf") {
    Decoder table(*tree, "");
    table.text("kind");
    const std::string file = table.text("file");
    if (Status status = table.finish(); !status) return fail(status.error());
    return response_plant((named.parent_path() / file).string(), measured);
  }
  std::vector<std::string> not_shown;
  const Result<NamedModel> model =
      kind == "aircraft" ? aircraft_model(*tree, path, measured, not_shown) : state_space_model(*tree, measured);
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
