// fatmc coordinator: serves a campaign to workers that are started by hand.
#include <memory>

#include "coordinator/cli/campaign_input.h"
#include "coordinator/cli/campaign_session.h"
#include "coordinator/cli/command.h"
#include "proto/endpoint.h"

namespace fatmc::cli {
namespace {

struct CoordinatorOptions {
  std::string spec, database, endpoint, keys;
  SpecChanges changes;
  bool verbose = false, retry_quarantined = false;
};

std::vector<std::string> resume_words(const CoordinatorOptions& options) {
  std::vector<std::string> words{"fatmc",          "coordinator", options.spec,    "--bind",
                                 options.endpoint, "--db",        options.database};
  if (!options.keys.empty()) words.insert(words.end(), {"--keys", options.keys});
  for (std::string& word : words_of(options.changes)) words.push_back(std::move(word));
  return words;
}

Exit serve(const CoordinatorOptions& options) {
  const Protection protection = options.keys.empty() ? Protection::plain : Protection::curve;
  if (const Status status = check_endpoint(options.endpoint, "--bind", protection); !status)
    return report(status.error());
  const Result<CampaignSpec> spec = read_campaign(options.spec, options.changes);
  if (!spec) return report(spec.error());
  SessionOptions session;
  session.database = options.database;
  session.endpoint = options.endpoint;
  session.keys = options.keys;
  session.verbose = options.verbose;
  session.retry_quarantined = options.retry_quarantined;
  session.resume_command = shell_line(resume_words(options));
  return run_session(*spec, session);
}

}  // namespace

void add_coordinator_command(CLI::App& app, Exit& exit) {
  auto options = std::make_shared<CoordinatorOptions>();
  CLI::App* command =
      app.add_subcommand("coordinator", "serves a campaign to workers that are started elsewhere");
  command->footer(
      "Without keys it may be reached from this machine alone. The database is resumed when it exists.\n"
      "Example: fatmc keygen keys\n"
      "         fatmc coordinator campaigns/coverage/spec.toml --bind \"tcp://*:5555\" --keys keys "
      "--db results/coverage.db\n"
      "         fatmc-worker --connect tcp://HOST:5555 --keys keys --jobs 2");
  command->add_option("SPEC", options->spec, "the campaign (TOML)")->required();
  command->add_option("--bind", options->endpoint, "endpoint, tcp://HOST:PORT or ipc://PATH")->required();
  command->add_option("--keys", options->keys,
                      "folder of keys made by `fatmc keygen` (needed: coordinator.key, workers.pub)");
  command->add_option("--db", options->database, "database")->required();
  add_spec_options(*command, options->changes);
  command->add_flag("--retry-quarantined", options->retry_quarantined,
                    "try trials again that were given up because they killed their workers");
  command->add_flag("--verbose", options->verbose, "log what is decided and why to standard error");
  command->callback([options, &exit] { exit = serve(*options); });
}

}  // namespace fatmc::cli
