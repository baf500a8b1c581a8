// fatmc replay: one trial again, bit for bit, with its record on request.
#include <cstdio>
#include <memory>

#include "campaigns/base/prepared_trials.h"
#include "campaigns/registry_trials.h"
#include "coordinator/cli/command.h"
#include "coordinator/cli/database_use.h"
#include "coordinator/cli/output_path.h"
#include "coordinator/cli/trial_name.h"
#include "coordinator/input/record_file.h"
#include "coordinator/store/campaign_store.h"
#include "core/base/text.h"
#include "core/record/column_file.h"
#include "core/base/build_hash.h"

namespace fatmc::cli {
namespace {

struct ReplayOptions {
  std::string database, trial, record;
  bool any_build = false;
};

Status check_target(const std::string& path) {
  if (path.empty()) return {};
  const std::string toml = record_toml_beside(path);
  if (toml == path) {
    return fail(Error{path, 0, "-o", "ends in .toml, name a CSV file: its roles go into the TOML beside it"});
  }
  if (Status status = check_output_file(path); !status) return status;
  return check_output_file(toml);
}

void print_metrics(const TrialRow& row) {
  for (const auto& [name, value] : row.metrics)
    std::printf("  %s = %s\n", name.c_str(), shortest(value).c_str());
  for (const auto& [name, values] : row.arrays)
    std::printf("  %s: %zu values\n", name.c_str(), values.size());
}

Exit write_record(const PreparedCell& cell, TrialKey key, const std::string& path) {
  const std::optional<TrialRecord> record = cell.record(key.repetition);
  if (!record || record->columns.rows() == 0) {
    std::fprintf(stderr, "fatmc: this trial has no record: %s\n",
                 record ? "its flight ended at once"
                        : "its study flies nothing, or its drawn parameters cannot be flown");
    return Exit::failed;
  }
  write_columns(path, record->names, record->columns);
  write_file_atomically(record_toml_beside(path), record->toml);
  std::printf("record: %s and %s\n", path.c_str(), record_toml_beside(path).c_str());
  return Exit::done;
}

// Says whether the row is the stored one.
Exit compare(const CampaignReader& reader, TrialKey key, const TrialRow& row, const std::string& name) {
  const std::string hash = hex(content_hash(row)).substr(0, 16);
  const std::optional<StoredRow> stored = reader.trial(key);
  const std::string outcome = row.outcome + (row.detail.empty() ? "" : " (" + row.detail + ")");
  if (!stored) {
    std::printf("%s: %s; not stored yet, so there is nothing to compare with\n", name.c_str(),
                outcome.c_str());
    return Exit::done;
  }
  if (stored->computed.hash == content_hash(row)) {
    std::printf("%s: %s; bit-identical to the stored row (content hash %s)\n", name.c_str(), outcome.c_str(),
                hash.c_str());
    return Exit::done;
  }
  std::fprintf(stderr, "fatmc: %s differs from the stored row: content hash %s, stored %s\n", name.c_str(),
               hash.c_str(), hex(stored->computed.hash).substr(0, 16).c_str());
  return Exit::failed;
}

Exit replay(const ReplayOptions& options) {
  if (Status status = check_target(options.record); !status) return report(status.error());
  const Result<CampaignReader> reader = CampaignReader::open(options.database);
  if (!reader) return report(reader.error());
  const CampaignSpec& spec = reader->spec();
  const Result<TrialKey> key = parse_trial(spec, options.trial);
  if (!key) return report(key.error());
  if (reader->build() != build_hash() && !options.any_build) {
    return report(
        Error{options.database, 0, "build",
              "was made by build " + reader->build().substr(0, 12) + ", this program is " +
                  build_hash().substr(0, 12) +
                  " and cannot promise the same bits; replay with that build, or see how far they agree by "
                  "--any-build"});
  }
  const Result<const TrialStudy*> study = require_trial_study(spec);
  if (!study) return report(study.error());
  const auto cell = prepare_trials(**study, spec, key->cell);
  if (!cell) return report(cell.error());
  TrialRow row = (*cell)->run(key->repetition);
  row.key = *key;
  const Exit compared = compare(*reader, *key, row, trial_name(spec, *key));
  print_metrics(row);
  if (options.record.empty()) return compared;
  const Exit written = write_record(**cell, *key, options.record);
  return compared == Exit::done ? written : compared;
}

}  // namespace

void add_replay_command(CLI::App& app, Exit& exit) {
  auto options = std::make_shared<ReplayOptions>();
  CLI::App* command = app.add_subcommand("replay", "computes one trial of a database again and compares it");
  command->footer(
      "Exit code 0: the same bits as stored; 1: they differ. TRIAL is CELL/REPETITION, or REPETITION where "
      "there is one "
      "cell.\n"
      "Example: fatmc replay results/coverage.db nonlinear/3 -o results/flight.csv");
  command->add_option("DB", options->database, "database")->required();
  command->add_option("TRIAL", options->trial, "the trial")->required();
  command->add_option("-o,--output", options->record,
                      "RECORD.csv of its flight; RECORD.toml is written beside it");
  command->add_flag("--any-build", options->any_build, "also where another build made the database");
  command->callback(
      [options, &exit] { exit = use_database(options->database, [&] { return replay(*options); }); });
}

}  // namespace fatmc::cli
