// fatmc run: a coordinator and its workers on this machine, until the campaign is done.
#include <memory>
#include <thread>

#include "coordinator/cli/campaign_input.h"
#include "coordinator/cli/campaign_session.h"
#include "coordinator/cli/command.h"

namespace fatmc::cli {
namespace {

struct RunOptions {
  std::string spec;
  std::string database;
  unsigned workers = std::max(1U, std::thread::hardware_concurrency());
  SpecChanges changes;
  bool verbose = false, retry_quarantined = false;
};

std::string resume_command(const RunOptions& options, const std::string& database) {
  std::vector<std::string> words{
      "fatmc", "run", options.spec, "--db", database, "--workers", std::to_string(options.workers)};
  for (std::string& word : words_of(options.changes)) words.push_back(std::move(word));
  return shell_line(words);
}

Exit run(const RunOptions& options) {
  const Result<CampaignSpec> spec = read_campaign(options.spec, options.changes);
  if (!spec) return report(spec.error());
  SessionOptions session;
  session.database = options.database.empty() ? default_database(*spec) : options.database;
  session.workers = options.workers;
  session.verbose = options.verbose;
  session.retry_quarantined = options.retry_quarantined;
  session.resume_command = resume_command(options, session.database);
  return run_session(*spec, session);
}

}  // namespace

void add_run_command(CLI::App& app, Exit& exit) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "runs a campaign on this machine and prints its tables");
  command->footer(
      "A database that exists is resumed; Ctrl-C stops cleanly (exit code 3), the same command goes on.\n"
      "Example: fatmc run campaigns/coverage/spec.toml --trials 200 --workers 2");
  command->add_option("SPEC", options->spec, "the campaign (TOML)")->required();
  command->add_option("--db", options->database,
                      "database (default: results/NAME.db, by the campaign's name)");
  command->add_option("--workers", options->workers, "worker processes")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  add_spec_options(*command, options->changes);
  command->add_flag("--retry-quarantined", options->retry_quarantined,
                    "try trials again that were given up because they killed their workers");
  command->add_flag("--verbose", options->verbose, "log what is decided and why to standard error");
  command->callback([options, &exit] { exit = run(*options); });
}

}  // namespace fatmc::cli
