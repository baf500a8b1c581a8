#include "campaigns/base/experiment.h"

#include <algorithm>
#include <cmath>

#include "campaigns/base/decoder.h"
#include "core/signal/crest_factor.h"

namespace fatmc {
namespace {

Status decode_excitation(const Tree& tree, double rate_hz, Excitation& out) {
  Decoder table(tree, "excitation");
  out.period_s = table.real("period_s", {.low = 0.1, .high = 1e5});
  out.periods = static_cast<int>(table.integer("periods", {.low = 2, .high = 1000}));
  out.ranges = decode_ranges(table, "ranges_hz");
  const std::vector<double> amplitude = table.reals("amplitude_rad_s", 3, {.low = 0.0, .high = 10.0});
  std::copy(amplitude.begin(), amplitude.end(), out.amplitude_rad_s.begin());
  const std::string phases = table.choice("phases", {"random", "schroeder", "low_crest"}, "random");
  if (phases == "schroeder") out.phases = Phases::schroeder;
  if (phases == "low_crest") out.phases = Phases::low_crest;
  out.zippered = table.choice("lines", {"shared", "zippered"}, "shared") == "zippered";
  if (Status status = table.finish(); !status) return status;
  if (out.phases == Phases::schroeder && !out.zippered) {
    const Tree* key = tree.find("phases");
    const Tree& place = key != nullptr ? *key : tree;
    return fail(
        Error{place.file, place.line, "excitation.phases",
              "schroeder gives all axes the same signal, which no estimator can tell apart: add lines = "
              "\"zippered\", or write low_crest"});
  }
  return resolve_excitation(out, rate_hz, tree);
}

void decode_controller(const Tree& tree, FlightSetup& out, Decoder& top) {
  Decoder table(tree, "controller");
  const std::vector<double> gain = table.reals("gain", 3, {.low = -100.0, .high = 100.0});
  out.gain = Eigen::Vector3d(gain[0], gain[1], gain[2]);
  out.turn_coordinator = table.boolean("turn_coordinator", true);
  out.closed_loop = table.boolean("closed_loop", true);
  top.take(table.finish());
}

void decode_simulation(const Tree& tree, FlightSetup& out, Decoder& top) {
  Decoder table(tree, "simulation");
  out.plant = table.choice("plant", {"nonlinear", "linear"}, "nonlinear") == "linear"
                  ? FlightSetup::Plant::linear
                  : FlightSetup::Plant::nonlinear;
  out.rate_hz = table.real("rate_hz", {.low = 1.0, .high = 1000.0}, 50.0);
  out.step_s = table.real("rk4_step_s", {.low = 1e-5, .high = 0.1}, 0.02);
  out.imu_step_s = table.real("imu_step_s", {.low = 1e-5, .high = 0.1}, 0.005);
  out.average_imu = table.boolean("average_imu", false);
  top.take(table.finish());
}

}  // namespace

std::vector<FrequencyRange> decode_ranges(Decoder& table, std::string_view key) {
  std::vector<FrequencyRange> out;
  for (const std::vector<double>& row : table.matrix(key, 0, 3, {.low = 0.0, .high = 1e4})) {
    out.push_back({row[0], row[1], row[2]});
  }
  return out;
}

Status resolve_excitation(Excitation& excitation, double rate_hz, const Tree& where) {
  const double samples = excitation.period_s * rate_hz;
  if (std::abs(samples - std::round(samples)) > 1e-6 * samples) {
    return fail(Error{where.file, where.line, "excitation.period_s",
                      "is no whole number of samples, write a multiple of 1/rate_hz"});
  }
  constexpr double kMostSamples = 2e7;  // of a record: 13 channels of that length are 2 GB
  if (samples * excitation.periods > kMostSamples) {
    return fail(Error{where.file, where.line, "excitation.period_s",
                      "times periods and rate gives more than 20,000,000 samples, write a shorter record"});
  }
  excitation.period_samples = static_cast<int>(std::lround(samples));
  auto lines = lines_from_ranges(excitation.ranges, 1.0 / excitation.period_s);
  if (!lines) {
    return fail(Error{where.file, where.line, "excitation.ranges_hz", lines.error().message});
  }
  if (2 * lines->back() >= excitation.period_samples) {
    return fail(Error{where.file, where.line, "excitation.ranges_hz",
                      "reaches half the sampling rate, write frequencies below it"});
  }
  excitation.lines = std::move(*lines);
  if (excitation.zippered && excitation.lines.size() < 3) {
    return fail(Error{where.file, where.line, "excitation.ranges_hz",
                      "has fewer lines than axes, which zippered lines cannot be shared among: write more"});
  }
  return {};
}

Result<Experiment> decode_experiment(const Tree& tree, const AircraftModel& model) {
  Experiment out;
  Decoder top(tree, "");
  top.choice("kind", {"experiment"});
  if (const Tree* controller = top.table("controller")) decode_controller(*controller, out.flight, top);
  if (const Tree* simulation = top.table("simulation", false))
    decode_simulation(*simulation, out.flight, top);
  if (const Tree* environment = top.table("environment", false)) {
    Decoder table(*environment, "environment");
    out.flight.turbulence_m_s = table.real("turbulence_sigma_m_s", {.low = 0.0, .high = 20.0}, 0.0);
    if (table.choice("gusts", {"all", "longitudinal"}, "all") == "longitudinal")
      out.flight.gusts = FlightSetup::Gusts::longitudinal;
    out.flight.gusts_from_calm = table.boolean("gusts_from_calm", false);
    top.take(table.finish());
  }
  if (const Tree* imu = top.table("imu", false)) {
    Decoder table(*imu, "imu");
    std::vector<std::string> grades = {"none"};
    for (const Imu& unit : model.imus) grades.push_back(unit.grade);
    const std::string grade = table.choice("grade", grades);
    if (const Imu* unit = model.imu(grade)) out.flight.imu = *unit;
    top.take(table.finish());
  }
  if (const Tree* excitation = top.table("excitation")) {
    if (!top.error()) top.take(decode_excitation(*excitation, out.flight.rate_hz, out.excitation));
  }
  if (Status status = top.finish(); !status) return fail(status.error());
  return out;
}

Error locate_flight_error(const Error& error, const Tree& model, const Tree& experiment) {
  static constexpr std::array<std::array<std::string_view, 3>, 4> kKeys = {{
      {"rate_hz", "simulation", "rate_hz"},
      {"step_s", "simulation", "rk4_step_s"},
      {"imu_step_s", "simulation", "imu_step_s"},
      {"turbulence_m_s", "environment", "turbulence_sigma_m_s"},
  }};
  for (const auto& [own, table_name, key] : kKeys) {
    if (error.key != own) continue;
    const Tree* table = experiment.find(table_name);
    const Tree* entry = table != nullptr ? table->find(key) : nullptr;
    const Tree& place = entry != nullptr ? *entry : experiment;
    return {place.file, place.line, std::string(table_name) + "." + std::string(key), error.message};
  }
  const Tree* trim = model.find("trim");
  const Tree* speed = trim != nullptr ? trim->find("speed_m_s") : nullptr;
  const Tree& place = speed != nullptr ? *speed : model;
  return {place.file, place.line, error.key == "speed_m_s" ? "trim.speed_m_s" : error.key, error.message};
}

std::vector<int> Excitation::lines_of(int axis) const {
  return zippered ? zippered_lines(lines, axis, 3) : lines;
}

std::array<Multisine, 3> reference_multisines(const Experiment& experiment, const TrialSeed& trial) {
  const Excitation& excitation = experiment.excitation;
  RandomStream stream(trial, "excitation");
  const auto signal = [&](int axis) {
    std::vector<int> lines = excitation.lines_of(axis);
    const double amplitude = excitation.amplitude_rad_s[static_cast<std::size_t>(axis)];
    if (excitation.phases == Phases::schroeder && amplitude > 0.0) {
      std::vector<double> amplitudes(lines.size(), amplitude);
      return schroeder_phases(excitation.period_samples, std::move(lines), std::move(amplitudes));
    }
    Multisine random =
        Multisine::random_phase(excitation.period_samples, std::move(lines), amplitude, stream);
    return excitation.phases == Phases::low_crest ? lower_crest_factor(random).signal : random;
  };
  // Braces: the axes draw one after the other.
  return {signal(0), signal(1), signal(2)};
}

Eigen::MatrixX3d reference_signal(const Experiment& experiment, const TrialSeed& trial) {
  const Excitation& excitation = experiment.excitation;
  Eigen::MatrixX3d out(excitation.periods * excitation.period_samples, 3);
  const std::array<Multisine, 3> signals = reference_multisines(experiment, trial);
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<double> samples = signals[static_cast<std::size_t>(axis)].samples(excitation.periods);
    out.col(axis) = Eigen::Map<const Eigen::VectorXd>(samples.data(), out.rows());
  }
  return out;
}

}  // namespace fatmc
