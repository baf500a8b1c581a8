// fatmc export: a model of the candidates study as a MODEL file.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "campaigns/base/prepared_trials.h"
#include "campaigns/candidates/candidates_spec.h"
#include "campaigns/candidates/flight_test.h"
#include "campaigns/candidates/model_table.h"
#include "coordinator/cli/database_use.h"
#include "coordinator/cli/model_commands.h"
#include "coordinator/cli/output_path.h"
#include "coordinator/cli/state_space_file.h"
#include "coordinator/store/campaign_store.h"
#include "core/base/text.h"
#include "core/record/column_file.h"

namespace fatmc::cli {
namespace {

using candidates::CandidatesSpec;
using candidates::ModelRow;
using candidates::ModelTable;

struct ExportOptions {
  std::string database, cell, output, records;
  std::vector<int> model;  ///< p, f, n
};

Result<std::uint32_t> cell_of(const CampaignSpec& spec, const std::string& name) {
  if (name.empty()) return std::uint32_t{0};
  std::vector<std::string> names;
  for (std::uint32_t i = 0; i < spec.cells.size(); ++i) {
    if (spec.cells[i].name == name) return i;
    names.push_back("\"" + spec.cells[i].name + "\"");
  }
  return fail(Error{"", 0, "--cell", "there is no \"" + name + "\", take one of " + join(names)});
}

/// The model asked for, or the best candidate of the last selection that has one.
Result<std::size_t> chosen_model(const ModelTable& table, const CandidatesSpec& spec,
                                 const std::vector<int>& wanted) {
  if (wanted.empty()) {
    for (auto selection = spec.selections.rbegin(); selection != spec.selections.rend(); ++selection) {
      for (const std::size_t i : candidates::select(table, *selection).candidates) {
        if (table.analysis_of(i) != nullptr) return i;
      }
    }
    return fail("no selection of the study has a candidate, name a model by --model P,F,N");
  }
  for (std::size_t i = 0; i < table.models.size(); ++i) {
    const ModelRow& model = table.models[i];
    if (model.past != wanted[0] || model.future != wanted[1] || model.order != wanted[2]) continue;
    if (table.analysis_of(i) != nullptr) return i;
    return fail(
        Error{"", 0, "--model",
              "is not kept: models of the orders that are selected from are, where they were identified, "
              "validated and have a continuous counterpart"});
  }
  return fail(Error{"", 0, "--model", "is not among the models of the database"});
}

/// DIR/sweep-1.csv ... and multistep-1.csv ... as they were measured, each with its TOML.
void write_records(const CandidatesSpec& spec, const TrialSeed& seed, const std::string& folder) {
  const candidates::FlownTest flown = candidates::fly_test(spec.truth, spec.flight, seed);
  std::vector<std::string> names = candidates::input_names();
  names.insert(names.end(), candidates::output_names().begin(), candidates::output_names().end());
  const auto quoted = [](const std::vector<std::string>& list) {
    return "[\"" + join(list, "\", \"") + "\"]";
  };
  const std::string toml = "[record]\nrate_hz = " + shortest(spec.truth.rate_hz) +
                           "\ninput = " + quoted(candidates::input_names()) +
                           "\noutput = " + quoted(candidates::output_names()) +
                           "   # m/s, rad/s, rad; inputs in per cent\nhold = \"zoh\"\n";
  std::filesystem::create_directories(folder);
  const auto write = [&](const char* kind, const std::vector<Maneuver>& maneuvers) {
    for (std::size_t k = 0; k < maneuvers.size(); ++k) {
      const Maneuver& maneuver = maneuvers[k];
      Eigen::MatrixXd values(maneuver.samples(), maneuver.inputs.cols() + maneuver.outputs.cols());
      values << maneuver.inputs, maneuver.outputs;
      const std::string path = folder + "/" + kind + "-" + std::to_string(k + 1);
      write_columns(path + ".csv", names, values);
      write_file_atomically(path + ".toml", toml);
    }
  };
  write("sweep", flown.sweeps);
  write("multistep", flown.multisteps);
  std::printf("%s: %zu sweeps, %zu multisteps\n", folder.c_str(), flown.sweeps.size(),
              flown.multisteps.size());
}

Exit run_export(const ExportOptions& options) {
  if (options.output.empty() && options.records.empty())
    return report(Error{"", 0, "-o", "is needed, or --records DIR"});
  if (!options.output.empty()) {
    if (Status status = check_output_file(options.output); !status) return report(status.error());
  }
  if (!options.records.empty()) {
    if (Status status = check_output_directory(options.records, "--records"); !status)
      return report(status.error());
  }
  const auto reader = CampaignReader::open(options.database);
  if (!reader) return report(reader.error());
  if (reader->spec().study != "candidates") {
    return report(
        Error{options.database, 0, "study",
              "is \"" + reader->spec().study + "\", only a database of the study candidates holds models"});
  }
  const Result<std::uint32_t> cell = cell_of(reader->spec(), options.cell);
  if (!cell) return report(cell.error());
  const auto own = spec_of_cell(reader->spec(), *cell);
  if (!own) return report(own.error());
  const auto spec = candidates::decode_candidates(*own);
  if (!spec) return report(spec.error());
  if (!options.records.empty()) write_records(*spec, reader->spec().trial_seed({*cell, 0}), options.records);
  if (options.output.empty()) return Exit::done;
  const auto read = candidates::read_models(*cell, reader->rows());
  if (!read) {
    Error error = read.error();
    error.file = options.database;
    return report(error);
  }
  const ModelTable& table = *read;
  const Result<std::size_t> model = chosen_model(table, *spec, options.model);
  if (!model) return report(model.error());
  const ModelRow& row = table.models[*model];
  const std::string name = "p " + std::to_string(row.past) + ", f " + std::to_string(row.future) + ", n " +
                           std::to_string(row.order);
  write_file_atomically(options.output,
                        state_space_toml("candidate " + name + " of " + reader->spec().name + ", " +
                                             reader->spec().cells[*cell].name + ", in modal coordinates",
                                         spec->truth.rate_hz, candidates::input_names(),
                                         candidates::output_names(), table.analysis_of(*model)->model.model));
  std::printf("%s: %s, overall d1 %s, norm of A_K^p %s\n", options.output.c_str(), name.c_str(),
              significant(row.agreement, 4).c_str(), significant(row.norm, 3).c_str());
  return Exit::done;
}

}  // namespace

void add_export_command(CLI::App& app, Exit& exit) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* command = app.add_subcommand(
      "export", "a model of the candidates study as a MODEL file, or its flight test as records");
  command->add_option("DB", options->database, "database of the study candidates")->required();
  command
      ->add_option(
          "--model", options->model,
          "P,F,N: past window, future window, order (default: the best candidate of the last selection)")
      ->delimiter(',')
      ->expected(3);
  command->add_option("--cell", options->cell, "name of the cell (default: the first)");
  command->add_option("-o,--output", options->output, "FILE.toml, kind state_space");
  command->add_option("--records", options->records,
                      "DIR: the sweeps and multisteps of the cell, flown again, as records with their TOML");
  command->footer("Example: fatmc export results/candidates.db --model 300,120,18 -o candidate.toml");
  command->callback(
      [options, &exit] { exit = use_database(options->database, [&] { return run_export(*options); }); });
}

}  // namespace fatmc::cli
