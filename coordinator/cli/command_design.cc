// fatmc design: what an experiment must be to show given modes, and what a given experiment is.
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "campaigns/base/aircraft_model.h"
#include "campaigns/base/experiment.h"
#include "coordinator/cli/command.h"
#include "coordinator/cli/experiment_design.h"
#include "coordinator/input/toml_file.h"
#include "core/base/text.h"
#include "core/ident/mode_design.h"
#include "core/ident/noise_model.h"

namespace fatmc::cli {
namespace {

using Json = nlohmann::ordered_json;

struct DesignArguments {
  std::vector<std::string> modes;
  DesignOptions options;
  std::string experiment, model;
  std::string format = "text";
  std::optional<double> noise_error;
};

/// "0.323,0.185"
Result<Mode> parse_mode(const std::string& text) {
  char* end = nullptr;
  Mode mode;
  mode.f0_hz = std::strtod(text.c_str(), &end);
  if (*end == ',') {
    const char* second = end + 1;
    mode.damping = std::strtod(second, &end);
    if (end != second && *end == '\0' && mode.f0_hz > 0.0 && mode.f0_hz < 1e6 && mode.damping > 1e-6 &&
        mode.damping < 10.0) {
      return mode;
    }
  }
  return fail(Error{"", 0, "--mode",
                    "\"" + text +
                        "\" is no pair F0,DAMPING of a frequency in Hz and a damping ratio, both "
                        "positive, for instance 0.329,0.184"});
}

Json mode_json(const Mode& mode, const ModeRequirement& need) {
  return {{"f0_hz", mode.f0_hz},
          {"damping", mode.damping},
          {"b_3db_hz", need.b_3db_hz},
          {"duration_table_3_1_s", need.duration_table_s},
          {"duration_corrected_s", need.duration_corrected_s},
          {"resolution_table_3_1_hz", 1.0 / need.duration_table_s},
          {"resolution_corrected_hz", 1.0 / need.duration_corrected_s},
          {"line_spacing_hz", need.spacing_hz},
          {"intergrid_damping_3db", need.intergrid_damping}};
}

Json bias_json(const PeakBias& bias) {
  return {{"exact", bias.exact},       {"discrete", bias.discrete},
          {"limit", bias.limit},       {"printed", bias.printed ? Json(*bias.printed) : Json()},
          {"constant", bias.constant}, {"intergrid", bias.intergrid}};
}

void print_mode(const Mode& mode, const ModeRequirement& need, const DesignOptions& options) {
  std::printf("mode at %s Hz, damping %s: 3-dB width %s Hz\n", shortest(mode.f0_hz).c_str(),
              shortest(mode.damping).c_str(), significant(need.b_3db_hz, 4).c_str());
  std::printf(
      "  period to resolve it: %s s as in Table 3-1, %s s by (2.140) corrected; resolution %s and %s Hz\n",
      significant(need.duration_table_s, 4).c_str(), significant(need.duration_corrected_s, 4).c_str(),
      significant(1.0 / need.duration_table_s, 4).c_str(),
      significant(1.0 / need.duration_corrected_s, 4).c_str());
  std::printf("  lines at most %s Hz apart for a bias of %s %% at its peak (n_E %d, order %d)\n",
              significant(need.spacing_hz, 4).c_str(), significant(100.0 * options.relative_bias, 3).c_str(),
              options.n_e, options.order);
}

void print_bias(const std::string& where, const PeakBias& bias) {
  const auto percent = [](double share) { return significant(100.0 * share, 3) + " %"; };
  std::printf(
      "  %s: bias at the peak %s; by (2.133) with the constant of these lines (%s) %s, of many lines %s, "
      "printed %s; "
      "intergrid error up to %s\n",
      where.c_str(), percent(bias.exact).c_str(), significant(bias.constant, 4).c_str(),
      percent(bias.discrete).c_str(), percent(bias.limit).c_str(),
      bias.printed ? percent(*bias.printed).c_str() : "none", percent(bias.intergrid).c_str());
}

/// What the experiment's own lines make of the mode.
void add_line(const DesignedExperiment& experiment, const Mode& mode, bool text, Json& entry) {
  const std::optional<int> k = nearest_line(experiment.grid, mode.f0_hz);
  if (!k) {
    entry["experiment"] = nullptr;
    if (text) {
      std::printf("  the experiment does not excite it: it lies outside %s to %s Hz\n",
                  significant(experiment.grid.frequency_hz(0), 4).c_str(),
                  significant(experiment.grid.frequency_hz(experiment.grid.line_count() - 1), 4).c_str());
    }
    return;
  }
  const PeakBias bias = peak_bias(experiment.grid, *k, mode);
  entry["experiment"] = bias_json(bias);
  entry["experiment"]["line_hz"] = experiment.grid.frequency_hz(*k);
  entry["experiment"]["border"] = experiment.grid.border(*k);
  const std::string where = significant(experiment.grid.frequency_hz(*k), 4) + " Hz" +
                            (experiment.grid.border(*k) ? ", a border line" : "");
  if (text) print_bias("in the experiment, at its line of " + where, bias);
}

Result<Json> design(const DesignArguments& arguments) {
  Json json;
  const DesignOptions& options = arguments.options;
  const bool text = arguments.format == "text";
  std::vector<Mode> modes;
  for (const std::string& entry : arguments.modes) {
    Result<Mode> mode = parse_mode(entry);
    if (!mode) return fail(mode.error());
    modes.push_back(*mode);
  }
  std::optional<DesignedExperiment> experiment;
  if (!arguments.experiment.empty()) {
    Result<DesignedExperiment> designed = design_experiment(arguments.experiment, arguments.model, options);
    if (!designed) return fail(designed.error());
    experiment = std::move(*designed);
  }
  json["modes"] = Json::array();
  for (const Mode& mode : modes) {
    const ModeRequirement need = mode_requirement(mode, options.n_e, options.order, options.relative_bias);
    Json entry = mode_json(mode, need);
    if (text) print_mode(mode, need, options);
    const double spacing = options.spacing_hz.value_or(need.spacing_hz);
    const Result<LpmGrid> window = uniform_window(spacing, options.n_e, options.order);
    if (!window) return fail(window.error());
    const PeakBias bias = peak_bias(*window, options.n_e, mode);
    entry["uniform"] = bias_json(bias);
    entry["uniform"]["spacing_hz"] = spacing;
    if (text) print_bias("lines " + significant(spacing, 4) + " Hz apart", bias);
    if (experiment) add_line(*experiment, mode, text, entry);
    json["modes"].push_back(entry);
  }
  if (experiment) {
    json["experiment"] = experiment_json(*experiment);
    if (text) print_experiment(*experiment);
  }
  if (arguments.noise_error) {
    const int segments = required_segments(*arguments.noise_error);
    json["noise_segments"] = segments;
    if (text) {
      std::printf(
          "noise variances to %s %%: %d segments (A.6 corrected), that is %d times the inverse of the "
          "resolution (A.8)\n",
          significant(100.0 * *arguments.noise_error, 3).c_str(), segments, segments);
    }
  }
  return json;
}

Exit run_design(const DesignArguments& arguments) {
  if (arguments.modes.empty() && arguments.experiment.empty() && !arguments.noise_error) {
    return report(Error{"", 0, "design",
                        "has nothing to work on: give --mode F0,DAMPING, --experiment FILE --model FILE or "
                        "--noise-error SHARE"});
  }
  if (!arguments.experiment.empty() && arguments.model.empty()) {
    return report(
        Error{"", 0, "--model", "is missing: the experiment names gyros of the aircraft, give its file"});
  }
  const Result<Json> json = design(arguments);
  if (!json) return report(json.error());
  if (arguments.format == "json") std::cout << json->dump(2) << "\n";
  return Exit::done;
}

}  // namespace

void add_design_command(CLI::App& app, Exit& exit) {
  auto arguments = std::make_shared<DesignArguments>();
  DesignOptions& options = arguments->options;
  CLI::App* command = app.add_subcommand(
      "design", "Resolution, duration, bias, crest factor, correlation and SNR of an experiment.");
  command->add_option("--mode", arguments->modes,
                      "F0,DAMPING of a mode to show, Hz and ratio; may be repeated");
  command->add_option("--n-e", options.n_e, "lines on each side of a window: 9, the default of estimate")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--order", options.order, "degree of the polynomials: 2, the default of estimate")
      ->check(CLI::Range(0, 8))
      ->capture_default_str();
  command
      ->add_option("--bias", options.relative_bias,
                   "tolerated interpolation bias, a share of the peak: 0.0857, T's choice (2.140)")
      ->check(CLI::Range(1e-6, 1.0))
      ->capture_default_str();
  command
      ->add_option("--spacing", options.spacing_hz,
                   "distance of lines in Hz; absent: what the tolerated bias asks for")
      ->check(CLI::Range(1e-9, 1e6));
  command->add_option("--experiment", arguments->experiment, "experiment (TOML) to judge")
      ->check(CLI::ExistingFile);
  command->add_option("--model", arguments->model, "aircraft (TOML) of the experiment")
      ->check(CLI::ExistingFile);
  command->add_option("--seed", options.seed, "of the experiment's phases, as in simulate")
      ->capture_default_str();
  command
      ->add_option("--noise-error", arguments->noise_error,
                   "tolerated relative error of noise variances (A.6)")
      ->check(CLI::Range(1e-3, 10.0));
  command->add_option("--format", arguments->format, "text or json")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str();
  command->footer(
      "Example: fatmc design --mode 0.329,0.184 --experiment campaigns/experiments/chapter5.toml --model "
      "campaigns/models/fat.toml");
  command->callback([arguments, &exit] { exit = run_design(*arguments); });
}

}  // namespace fatmc::cli
