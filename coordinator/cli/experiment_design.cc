#include "coordinator/cli/experiment_design.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "campaigns/base/aircraft_model.h"
#include "campaigns/base/experiment.h"
#include "coordinator/input/toml_file.h"
#include "core/base/text.h"
#include "core/flight/flight.h"
#include "core/flight/turbulence_insensitivity.h"

namespace fatmc::cli {
namespace {

constexpr std::array<const char*, 3> kAxes = {"roll", "pitch", "yaw"};
constexpr std::array<std::array<std::size_t, 2>, 3> kPairs = {{{0, 1}, {0, 2}, {1, 2}}};

double decibel(double ratio) { return 20.0 * std::log10(ratio); }

AxisDesign axis_design(const Multisine& signal, const Flight& flight, const Experiment& experiment,
                       int axis) {
  AxisDesign out;
  const Excitation& excitation = experiment.excitation;
  const std::vector<double> x = signal.period();
  out.lines = static_cast<int>(signal.lines().size());
  out.rms = rms(x);
  for (const double value : x) out.peak = std::max(out.peak, std::abs(value));
  out.crest_factor = crest_factor(x);
  for (const int line : signal.lines()) {
    const double f = line / excitation.period_s;
    out.frequency_hz.push_back(f);
    out.insensitivity_db.push_back(
        decibel(turbulence_insensitivity(flight.sampled(), f)[static_cast<std::size_t>(axis)]));
    const double amplitude = excitation.amplitude_rad_s[static_cast<std::size_t>(axis)];
    const double snr = turbulence_limited_snr(
        flight.sampled(), axis, f, amplitude, excitation.period_s * excitation.periods,
        experiment.flight.turbulence_m_s, flight.aircraft().speed_m_s, flight.aircraft().span_m);
    if (experiment.flight.closed_loop && std::isfinite(snr) && snr > 0.0) out.snr_db.push_back(decibel(snr));
  }
  return out;
}

/// "-0.4 (0.29 Hz) to 8.1 dB (2.89 Hz)"
std::string range(const std::vector<double>& values, const std::vector<double>& frequency_hz) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const auto at = [&](auto it) {
    return significant(frequency_hz[static_cast<std::size_t>(it - values.begin())], 3) + " Hz";
  };
  return fixed(*low, 1) + " dB (" + at(low) + ") to " + fixed(*high, 1) + " dB (" + at(high) + ")";
}

}  // namespace

Result<DesignedExperiment> design_experiment(const std::string& experiment_path,
                                             const std::string& model_path, const DesignOptions& options) {
  const auto model_tree = read_toml_resolved(model_path);
  if (!model_tree) return fail(model_tree.error());
  const auto model = decode_aircraft_model(*model_tree);
  if (!model) return fail(model.error());
  const auto tree = read_toml_resolved(experiment_path);
  if (!tree) return fail(tree.error());
  const auto experiment = decode_experiment(*tree, *model);
  if (!experiment) return fail(experiment.error());
  const auto flight = prepare_flight(*model, experiment->flight);
  if (!flight) return fail(locate_flight_error(flight.error(), *model_tree, *tree));
  const Excitation& excitation = experiment->excitation;
  Result<LpmGrid> grid = LpmGrid::create(
      {excitation.lines, excitation.period_samples, excitation.periods, experiment->flight.rate_hz},
      {options.n_e, options.order, std::max(5, (options.order + 3) / 2)}, 3);
  if (!grid) {
    Error error = grid.error();
    error.file = experiment_path;
    return fail(error);
  }
  DesignedExperiment out{
      std::move(*grid), excitation.period_s, excitation.periods, excitation.zippered, {}, {}};
  const TrialSeed seed{static_cast<std::uint64_t>(options.seed), name_hash("simulate"), 0, 0};
  const std::array<Multisine, 3> signals = reference_multisines(*experiment, seed);
  for (int axis = 0; axis < 3; ++axis) {
    out.axes[static_cast<std::size_t>(axis)] =
        axis_design(signals[static_cast<std::size_t>(axis)], *flight, *experiment, axis);
  }
  if (!excitation.zippered && excitation.lines.size() >= 3) {
    out.correlation.emplace();
    for (std::size_t pair = 0; pair < 3; ++pair) {
      (*out.correlation)[pair] =
          phase_correlation(signals[kPairs[pair][0]].phases(), signals[kPairs[pair][1]].phases());
    }
  }
  return out;
}

nlohmann::ordered_json experiment_json(const DesignedExperiment& design) {
  nlohmann::ordered_json json;
  json["lines"] = design.grid.line_count();
  json["period_s"] = design.period_s;
  json["periods"] = design.periods;
  json["zippered"] = design.zippered;
  json["q"] = design.grid.q();
  json["axes"] = nlohmann::ordered_json::array();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const AxisDesign& a = design.axes[axis];
    json["axes"].push_back({{"axis", kAxes[axis]},
                            {"lines", a.lines},
                            {"rms", a.rms},
                            {"peak", a.peak},
                            {"crest_factor", a.crest_factor},
                            {"frequency_hz", a.frequency_hz},
                            {"turbulence_insensitivity_db", a.insensitivity_db},
                            {"turbulence_limited_snr_db", a.snr_db}});
  }
  json["phase_correlation"] = nullptr;
  if (design.correlation) {
    json["phase_correlation"] = nlohmann::ordered_json::array();
    for (std::size_t pair = 0; pair < 3; ++pair) {
      const PhaseCorrelation& c = (*design.correlation)[pair];
      json["phase_correlation"].push_back({{"axes", {kAxes[kPairs[pair][0]], kAxes[kPairs[pair][1]]}},
                                           {"rho", c.rho},
                                           {"p_rho", c.p_rho},
                                           {"difference", c.difference},
                                           {"p_difference", c.p_difference}});
    }
  }
  return json;
}

void print_experiment(const DesignedExperiment& design) {
  std::printf("experiment: %d lines, %d periods of %s s, q = %d\n", design.grid.line_count(), design.periods,
              significant(design.period_s, 6).c_str(), design.grid.q());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const AxisDesign& a = design.axes[axis];
    std::printf("  %-5s %d lines, rms %s, peak %s, crest factor %s\n", kAxes[axis], a.lines,
                significant(a.rms, 3).c_str(), significant(a.peak, 3).c_str(),
                fixed(a.crest_factor, 2).c_str());
    std::printf("        turbulence insensitivity (5.9) %s\n",
                range(a.insensitivity_db, a.frequency_hz).c_str());
    if (!a.snr_db.empty() && a.snr_db.size() == a.frequency_hz.size()) {
      std::printf("        input SNR by (5.9), the axis' own gust alone: %s\n",
                  range(a.snr_db, a.frequency_hz).c_str());
    }
  }
  if (!design.correlation) {
    std::printf("  zippered lines: no two axes share one\n");
    return;
  }
  for (std::size_t pair = 0; pair < 3; ++pair) {
    const PhaseCorrelation& c = (*design.correlation)[pair];
    std::printf("  phases of %s and %s: correlation (B.24) %s (p %s), of their difference %s (p %s)%s\n",
                kAxes[kPairs[pair][0]], kAxes[kPairs[pair][1]], fixed(c.rho, 3).c_str(),
                significant(c.p_rho, 2).c_str(), fixed(c.difference, 3).c_str(),
                significant(c.p_difference, 2).c_str(),
                c.p_difference < 1e-3 ? ": the axes go together, take another seed" : "");
  }
}

}  // namespace fatmc::cli
