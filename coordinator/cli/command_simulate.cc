// fatmc simulate: one flight as a record.
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>

#include "campaigns/base/aircraft_model.h"
#include "campaigns/base/experiment.h"
#include "campaigns/base/trial_record.h"
#include "coordinator/cli/command.h"
#include "coordinator/cli/output_path.h"
#include "coordinator/input/record_file.h"
#include "coordinator/input/toml_file.h"
#include "core/base/text.h"
#include "core/flight/effects/listing.h"
#include "core/record/column_file.h"

namespace fatmc::cli {
namespace {

struct Options {
  std::string model, experiment, record;
  std::vector<std::string> effects;
  std::int64_t seed = 0;
  std::int64_t repetition = 0;
};

struct Flown {
  AircraftModel model;
  Experiment experiment;
  FlightRecord record;
};

Result<Flown> fly(const Options& options) {
  Flown out;
  auto model_tree = read_toml_resolved(options.model);
  if (!model_tree) return fail(model_tree.error());
  auto model = decode_aircraft_model(*model_tree);
  if (!model) return fail(model.error());
  out.model = std::move(*model);
  auto experiment_tree = read_toml_resolved(options.experiment);
  if (!experiment_tree) return fail(experiment_tree.error());
  auto experiment = decode_experiment(*experiment_tree, out.model);
  if (!experiment) return fail(experiment.error());
  out.experiment = std::move(*experiment);
  std::vector<Effect> effects;
  for (const std::string& text : options.effects) {
    auto effect = parse_effect(text);
    if (!effect) return fail(Error{"--effect", 0, effect.error().key, effect.error().message});
    effects.push_back(std::move(*effect));
  }
  auto flight = prepare_flight(out.model, out.experiment.flight, effects);
  if (!flight) return fail(locate_flight_error(flight.error(), *model_tree, *experiment_tree));
  // A record of no campaign: study and cell are those of this command.
  const TrialSeed seed{static_cast<std::uint64_t>(options.seed), name_hash("simulate"), 0,
                       static_cast<std::uint64_t>(options.repetition)};
  flight->fly(reference_signal(out.experiment, seed), seed, out.record);
  return out;
}

// Nothing but an older record is overwritten, and what cannot be written is said before the flight.
Status check_targets(const std::string& csv_path, const std::string& toml_path) {
  namespace fs = std::filesystem;
  for (const std::string& path : {csv_path, toml_path}) {
    if (Status status = check_output_file(path); !status) return status;
  }
  if (fs::exists(toml_path)) {
    const Result<Tree> old = read_toml(toml_path);
    if (!old || old->find("record") == nullptr) {
      return fail(Error{toml_path, 0, "-o",
                        "exists and is no record's TOML: it would be overwritten, name another CSV"});
    }
  }
  return {};
}

Exit run(const Options& options) {
  if (options.effects == std::vector<std::string>{"list"}) {
    std::fputs(effect_listing().c_str(), stdout);
    return Exit::done;
  }
  if (options.effects == std::vector<std::string>{"table"}) {
    std::fputs(effect_table_markdown().c_str(), stdout);
    return Exit::done;
  }
  if (options.model.empty() || options.experiment.empty() || options.record.empty()) {
    return report(
        Error{"", 0, "simulate", "needs MODEL, EXPERIMENT and -o RECORD.csv (or --effect list alone)"});
  }
  const std::string toml_path = record_toml_beside(options.record);
  if (toml_path == options.record) {
    return report(Error{options.record, 0, "-o",
                        "ends in .toml, name a CSV file: its roles go into the TOML beside it"});
  }
  if (Status status = check_targets(options.record, toml_path); !status) return report(status.error());
  auto flown = fly(options);
  if (!flown) return report(flown.error());
  const FlightRecord& record = flown->record;
  if (record.ending != Ending::completed) {
    std::fprintf(stderr, "fatmc: the flight diverged (%s) at %s s; no record is written\n",
                 std::string(name(record.ending)).c_str(), significant(record.ending_time_s, 4).c_str());
    return Exit::failed;
  }
  const TrialRecord columns = trial_record(record, flown->experiment, flown->model.aircraft);
  write_columns(options.record, columns.names, columns.columns);
  write_file_atomically(toml_path, columns.toml);
  const auto percent = [](double share) { return significant(100.0 * share, 3) + " %"; };
  std::printf("%s: %s s at %s Hz, %zu lines, trim at %s m/s\n", options.record.c_str(),
              significant(static_cast<double>(record.samples) / flown->experiment.flight.rate_hz, 6).c_str(),
              shortest(flown->experiment.flight.rate_hz).c_str(), flown->experiment.excitation.lines.size(),
              shortest(flown->model.aircraft.speed_m_s).c_str());
  std::printf("  input rms: xi_c %s, eta_c %s, zeta_c %s\n", significant(record.input_rms(0), 3).c_str(),
              significant(record.input_rms(1), 3).c_str(), significant(record.input_rms(2), 3).c_str());
  std::printf("  time at limits (position, rate): aileron %s, %s; left %s, %s; right ruddervator %s, %s\n",
              percent(record.at_position_limit(0)).c_str(), percent(record.at_rate_limit(0)).c_str(),
              percent(record.at_position_limit(1)).c_str(), percent(record.at_rate_limit(1)).c_str(),
              percent(record.at_position_limit(2)).c_str(), percent(record.at_rate_limit(2)).c_str());
  std::printf("  roles of the columns: %s\n  next: fatmc estimate %s -o DIR\n", toml_path.c_str(),
              options.record.c_str());
  return Exit::done;
}

}  // namespace

void add_simulate_command(CLI::App& app, Exit& exit) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("simulate", "fly one experiment and write it as a record");
  command->add_option("MODEL", options->model, "aircraft (TOML)");
  command->add_option("EXPERIMENT", options->experiment, "experiment (TOML)");
  command->add_option("--seed", options->seed, "seed of excitation, turbulence and sensor noise")
      ->capture_default_str();
  command->add_option("--repetition", options->repetition, "another draw of the same seed")
      ->capture_default_str();
  command->add_option("-o,--output", options->record, "RECORD.csv; RECORD.toml is written beside it");
  command
      ->add_option("--effect", options->effects,
                   "an effect that the model lacks, ID:name=value,...; may be repeated; \"list\" prints "
                   "them, \"table\" as "
                   "the table of docs/effects.md")
      ->allow_extra_args(false);
  command->footer(
      "Examples: fatmc simulate campaigns/models/fat.toml campaigns/experiments/chapter5.toml --seed 1 -o "
      "flight.csv\n"
      "          fatmc simulate campaigns/models/fat.toml campaigns/experiments/chapter5.toml --effect "
      "transport_delay:delay_s=0.03 --effect control_effectiveness:axis=pitch,factor=0.8,onset_s=200 -o "
      "late.csv\n"
      "          fatmc simulate --effect list");
  command->callback([options, &exit] { exit = run(*options); });
}

}  // namespace fatmc::cli
