#include "coordinator/cli/diagnosis_input.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "campaigns/base/decoder.h"
#include "campaigns/base/trial_row.h"
#include "coordinator/cli/record_plausibility.h"
#include "coordinator/cli/turbulence_level.h"
#include "coordinator/input/record_file.h"
#include "coordinator/input/toml_file.h"
#include "core/base/build_hash.h"
#include "core/base/text.h"
#include "core/discrepancy/moment_filters.h"

namespace fatmc::cli {
namespace {

std::string file_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

/// The largest whole part of a tick that is not above `most`.
double part_of_tick(double rate_hz, double most) {
  const double tick = 1.0 / rate_hz;
  return tick / std::max(1.0, std::ceil(tick / most - 1e-9));
}

Status read_environment(const std::string& toml, const DiagnosedModel& model, DiagnosedRecord& out) {
  const Result<Tree> file = read_toml(toml);
  if (!file) return fail(file.error());
  const Tree* tree = file->find("environment");
  std::string grade = model.model.imus.empty() ? "none" : model.model.imus.front().grade;
  bool imu_stated = false;
  if (tree != nullptr) {
    Decoder table(*tree, "environment");
    out.turbulence_stated = table.has("turbulence_sigma_m_s");
    if (out.turbulence_stated)
      out.setup.turbulence_m_s = table.real("turbulence_sigma_m_s", {.low = 0.0, .high = 20.0});
    std::vector<std::string> grades = {"none"};
    for (const Imu& unit : model.model.imus) grades.push_back(unit.grade);
    imu_stated = table.has("imu_grade");
    grade = table.choice("imu_grade", grades, grade);
    out.setup.turn_coordinator = table.boolean("turn_coordinator", true);
    if (Status status = table.finish(); !status) return status;
  }
  if (const Imu* unit = model.model.imu(grade)) out.setup.imu = *unit;
  if (!imu_stated) {
    out.assumptions.push_back("The record does not name its gyros: the model's first grade, " + grade +
                              ", is assumed.");
  }
  return {};
}

/// The record's roles as those of a rate loop.
Status read_roles(const Record& record, const std::string& path, const std::string& toml,
                  DiagnosedRecord& out) {
  const auto wrong = [&](const char* key, std::string message) {
    return fail(Error{toml, 0, std::string("record.") + key, std::move(message)});
  };
  const auto three = [&](const char* key, const std::vector<int>& columns, const char* example) -> Status {
    if (columns.size() == 3) return {};
    return wrong(key, "names " + std::to_string(columns.size()) + " columns, the aircraft has three: write " +
                          example);
  };
  if (Status s = three("output", record.output, "[\"p\", \"q\", \"r\"], rates in rad/s"); !s) return s;
  if (Status s = three("input", record.input, "[\"xi_c\", \"eta_c\", \"zeta_c\"], commands in [-1, 1]"); !s)
    return s;
  out.setup.closed_loop = !record.reference.empty();
  if (out.setup.closed_loop) {
    if (Status s = three("reference", record.reference, "the three rate commands in rad/s"); !s) return s;
    if (!record.controller_gain) {
      return wrong("controller_gain",
                   "is missing: the loop cannot be flown without it, write K of u = K (r - y)");
    }
    const Eigen::MatrixXd& gain = *record.controller_gain;
    if (!Eigen::MatrixXd(gain - Eigen::MatrixXd(gain.diagonal().asDiagonal())).isZero(0.0)) {
      return wrong("controller_gain", "has elements off the diagonal, the simulated controller has none");
    }
    out.setup.gain = gain.diagonal();
    out.gain_stated = true;
  }
  out.record.output = record.channels(record.output);
  out.record.input = record.channels(record.input);
  out.record.reference = record.channels(out.setup.closed_loop ? record.reference : record.input);
  const auto auxiliary = [&](const char* name) {
    const int c = record.column(name);
    return std::find(record.auxiliary.begin(), record.auxiliary.end(), c) != record.auxiliary.end() ? c : -1;
  };
  const int phi = auxiliary("phi"), theta = auxiliary("theta"), speed = auxiliary("V");
  if (phi >= 0 && theta >= 0) {
    out.record.attitude = record.channels({phi, theta});
  } else {
    out.record.attitude.resize(record.sample_count(), 0);
    out.assumptions.push_back(
        "No attitude was recorded (auxiliary phi, theta): errors of the gyros look like errors of the "
        "controls.");
  }
  if (speed >= 0) {
    out.record.airspeed = record.channels({speed});
  } else {
    out.record.airspeed.resize(record.sample_count(), 0);
    out.assumptions.push_back(
        "No airspeed was recorded (auxiliary V): mass and airspeed are hard to tell apart.");
  }
  return check_plausible(out.record, out.setup, record.rate_hz, path);
}

}  // namespace

Result<DiagnosedModel> read_diagnosed_model(const std::string& path) {
  DiagnosedModel out;
  out.path = path;
  auto tree = read_toml_resolved(path);
  if (!tree) return fail(tree.error());
  const Tree* kind = tree->find("kind");
  const auto* name = kind != nullptr ? std::get_if<std::string>(&kind->value) : nullptr;
  if (name != nullptr && *name != "aircraft") {
    return fail(Error{path, kind->line, "kind",
                      "is \"" + *name +
                          "\": diagnose takes models of kind \"aircraft\", \"state_space\", \"frf\" or "
                          "\"recorded_output\""});
  }
  auto model = decode_aircraft_model(*tree);
  if (!model) return fail(model.error());
  out.model = std::move(*model);
  out.effects = out.model.effects;
  out.text = file_text(path);
  return out;
}

Result<DiagnosedRecord> read_diagnosed_record(const std::string& path, const DiagnosedModel& model) {
  auto record = read_record(path);
  if (!record) return fail(record.error());
  if (Status status = complete_period(*record, path); !status) return fail(status.error());
  DiagnosedRecord out;
  out.path = path;
  out.data_hash = hex(sha256(file_text(path)));
  const int samples = record->period_samples * record->periods;
  if (samples < record->sample_count()) {
    record->samples = record->samples.topRows(samples).eval();
    out.assumptions.push_back("What follows the last whole period is left out.");
  }
  out.experiment = {record->excited_lines, record->period_samples, record->periods, record->rate_hz};
  out.setup.rate_hz = record->rate_hz;
  out.setup.step_s = part_of_tick(record->rate_hz, 0.02);
  out.setup.imu_step_s = part_of_tick(record->rate_hz, 0.005);
  const std::string toml = record_toml_beside(path);
  if (Status status = read_environment(toml, model, out); !status) return fail(status.error());
  if (Status status = read_roles(*record, path, toml, out); !status) return fail(status.error());
  return out;
}

Result<PreparedRecord> prepare_record(DiagnosedRecord& record, const DiagnosedModel& model,
                                      const std::vector<Effect>& effects, int threads) {
  const auto place = [&](Error error) {
    if (error.file.empty()) error.file = record.path;
    return fail(std::move(error));
  };
  const bool controller = record.gain_stated && (record.setup.gain.array() != 0.0).all();
  auto layout = FeatureLayout::create(record.experiment, record.record.has_attitude(),
                                      record.record.has_airspeed(), controller);
  if (!layout) return place(layout.error());
  auto grid = LpmGrid::create(record.experiment, {}, 3);
  if (!grid) return place(grid.error());
  const FeatureExtractor extractor(*layout, record.setup.gain);
  std::vector<Effect> own = model.effects;
  own.insert(own.end(), effects.begin(), effects.end());
  const auto simulator = [&](const FlightSetup& setup) {
    return std::make_unique<ModelSimulator>(model.model.aircraft, setup, own, record.record.reference,
                                            extractor);
  };
  PreparedRecord out{nullptr, std::move(*grid), {}, extractor.extract(record.record)};
  out.basis.threads = threads;
  if (!record.turbulence_stated) {
    auto level = estimate_turbulence(record.setup, out.features, simulator, threads);
    if (!level) return place(level.error());
    record.setup.turbulence_m_s = *level;
    // 10 % of the level: what its estimate may err by, the step of its grid included.
    auto nuisance = parse_effect("turbulence:factor=1.2");
    if (!nuisance) return fail(nuisance.error());
    if (*level > 0.0) out.basis.nuisances.push_back({*nuisance, 0.1 / std::log(1.2)});
    out.basis.excluded.emplace_back("turbulence");
  }
  out.model = std::make_unique<ModelSimulator>(with_moment_filters(*simulator(record.setup)));
  out.features = out.model->extractor().extract(record.record);
  if (Status status = check_against_model(record.record, *out.model, record.path); !status)
    return fail(status.error());
  return out;
}

std::string basis_key(const PreparedRecord& record, const DiagnosedModel& model) {
  const FlightSetup& setup = record.model->setup();
  std::string text = build_hash() + "\n" + model.text + "\n";
  const auto number = [&](double value) { text += shortest(value) + " "; };
  for (const double v :
       {setup.rate_hz, setup.step_s, setup.imu_step_s, setup.turbulence_m_s, setup.gain[0], setup.gain[1],
        setup.gain[2], setup.turn_coordinator ? 1.0 : 0.0, setup.closed_loop ? 1.0 : 0.0}) {
    number(v);
  }
  text += setup.imu.grade + "\n";
  for (const Effect& effect : record.model->own_effects()) text += effect.text() + "\n";
  const FeatureLayout& layout = record.model->extractor().layout();
  for (const int line : layout.experiment.lines) number(line);
  number(layout.experiment.periods);
  number(layout.experiment.period_samples);
  text += join(layout.channels) + (layout.controller ? " controller" : "") + "\n" +
          join(record.basis.excluded) + "\n";
  number(record.basis.flights);
  for (const Nuisance& n : record.basis.nuisances) text += n.effect.text() + " " + shortest(n.scale) + "\n";
  const Eigen::MatrixX3d& reference = record.model->reference();
  text.append(reinterpret_cast<const char*>(reference.data()),
              static_cast<std::size_t>(reference.size()) * sizeof(double));
  return hex(sha256(text));
}

}  // namespace fatmc::cli
