// fatmc run: a coordinator and its workers on this machine, until the campaign is done.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <set>
#include <thread>

#include "coordinator/cli/campaign_input.h"
#include "coordinator/cli/campaign_session.h"
#include "coordinator/cli/command.h"
#include "coordinator/cli/database_use.h"
#include "coordinator/cli/launch_options.h"
#include "coordinator/cli/plan_listing.h"
#include "coordinator/cli/study_list.h"

namespace fatmc::cli {
namespace {

struct RunOptions {
  std::string spec;
  std::string database, shard;
  unsigned workers = std::max(1U, std::thread::hardware_concurrency());
  LaunchOptions launch;
  SpecChanges changes;
  bool verbose = false, retry_quarantined = false;
  bool dry_run = false;
  std::string list;                  ///< the file that lists this spec; empty: it was named itself
  std::vector<std::string> earlier;  ///< databases of the specs before it in the list
};

std::string resume_command(const RunOptions& options, const std::string& database) {
  std::vector<std::string> words{"fatmc", "run", options.list.empty() ? options.spec : options.list};
  if (options.list.empty()) words.insert(words.end(), {"--db", database});
  words.insert(words.end(), {"--workers", std::to_string(options.workers)});
  if (!options.shard.empty()) words.insert(words.end(), {"--shard", options.shard});
  for (std::string& word : words_of(options.launch)) words.push_back(std::move(word));
  for (std::string& word : words_of(options.changes)) words.push_back(std::move(word));
  return shell_line(words);
}

// A shard of more parts than a cell has repetitions may be empty: a mistake in i/N, and nothing to merge.
Status has_trials(const Shard& shard, const CampaignSpec& spec) {
  std::uint64_t most = 0;
  for (const Cell& cell : spec.cells) {
    const auto [first, last] = shard.range(cell.repetitions);
    if (first < last) return {};
    most = std::max<std::uint64_t>(most, cell.repetitions);
  }
  return fail("--shard " + std::to_string(shard.number) + "/" + std::to_string(shard.count) +
              " holds no trial: no cell has more than " + std::to_string(most) +
              " repetitions, split it in so many parts at most");
}

// [stop] looks at trials 0 ... n-1 of a cell, of which a shard has a part.
Result<Shard> shard_of(const RunOptions& options, const CampaignSpec& spec) {
  if (options.shard.empty()) return Shard{};
  const Result<Shard> shard = parse_shard(options.shard);
  if (!shard) return shard;
  if (Status status = has_trials(*shard, spec); !status) return fail(status.error());
  const Tree* stop = spec.tree.find("stop");
  if (shard->count == 1 || stop == nullptr) return shard;
  return fail(Error{stop->file, stop->line, "stop",
                    "needs all trials of a cell, and --shard " + options.shard +
                        " has a part of them; leave out one of the two"});
}

// Workers here, or a launcher for those elsewhere.
Status use_launcher(const RunOptions& options, const CampaignSpec& spec, SessionOptions& session) {
  if (options.launch.is_local()) {
    session.workers = options.workers;
    return {};
  }
  Result<std::string> keys = key_folder(options.launch, session.database);
  if (!keys) return fail(keys.error());
  session.keys = *keys;
  session.endpoint = bind_endpoint(options.launch, spec);
  session.launcher = [&options, &spec, &session](const std::string& endpoint) {
    return make_launcher(options.launch, spec, session.database, session.keys, endpoint, options.workers);
  };
  return {};
}

Exit run_one(const RunOptions& options, const CampaignSpec& campaign) {
  const CampaignSpec* spec = &campaign;
  SessionOptions session;
  const Result<Shard> shard = shard_of(options, *spec);
  if (!shard) return report(shard.error());
  session.shard = *shard;
  const std::string database =
      options.database.empty() ? default_database(*spec, session.shard) : options.database;
  if (options.dry_run)
    return use_database(database, [&] {
      print_plan(*spec, database);
      return Exit::done;
    });
  session.database = database;
  session.earlier = options.earlier;
  if (Status status = use_launcher(options, *spec, session); !status) return report(status.error());
  session.verbose = options.verbose;
  session.retry_quarantined = options.retry_quarantined;
  session.resume_command = resume_command(options, session.database);
  return run_session(*spec, session);
}

// Everything is read before anything is run.
Exit run_list(const RunOptions& options, const std::vector<std::string>& paths) {
  if (!options.database.empty()) {
    return report(Error{"", 0, "--db",
                        "is for a single campaign, and " + options.spec +
                            " lists several; leave it out, each has results/NAME.db"});
  }
  std::vector<CampaignSpec> specs;
  std::set<std::string> names;
  for (const std::string& path : paths) {
    Result<CampaignSpec> spec = read_campaign(path, options.changes);
    if (!spec) return report(spec.error());
    if (const auto shard = shard_of(options, *spec); !shard) return report(shard.error());
    if (!names.insert(spec->name).second) {
      return report(Error{path, 0, "campaign.name",
                          "\"" + spec->name + "\" names two campaigns of " + options.spec +
                              ", whose databases would be one; write another"});
    }
    specs.push_back(std::move(*spec));
  }
  const Shard shard = options.shard.empty() ? Shard{} : parse_shard(options.shard).value_or(Shard{});
  RunOptions own = options;
  own.list = options.spec;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    own.spec = paths[i];
    std::printf("%s%s:\n", i > 0 ? "\n" : "", paths[i].c_str());
    std::fflush(stdout);
    if (const Exit exit = run_one(own, specs[i]); exit != Exit::done) return exit;
    own.earlier.push_back(default_database(specs[i], shard));
  }
  return Exit::done;
}

Exit run(const RunOptions& options) {
  if (const Status status = check(options.launch); !status) return report(status.error());
  const Result<std::vector<std::string>> listed = listed_specs(options.spec);
  if (!listed) return report(listed.error());
  if (!listed->empty()) return run_list(options, *listed);
  const Result<CampaignSpec> spec = read_campaign(options.spec, options.changes);
  return spec ? run_one(options, *spec) : report(spec.error());
}

}  // namespace

void add_run_command(CLI::App& app, Exit& exit) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "runs a campaign on this machine and prints its tables");
  command->alias(
      "candidates");  // the same words for the study of many PBSIDopt models: fatmc candidates SPEC
  command->footer(
      "A database that exists is resumed; Ctrl-C stops cleanly (exit code 3), the same command goes on.\n"
      "Example: fatmc run campaigns/coverage/spec.toml --trials 200 --workers 2\n"
      "    and: fatmc run campaigns/coverage/spec.toml --launcher slurm --workers 40 "
      "--sbatch=--partition=long\n"
      "    and: fatmc candidates campaigns/candidates/spec.toml --size small\n"
      "    and: fatmc run campaigns/coverage/spec.toml --launcher ssh --hosts node1:8,node2:8");
  command
      ->add_option("SPEC", options->spec,
                   "the campaign (TOML), or a list of several ([[study]] spec = \"FILE\")")
      ->required();
  command->add_option("--db", options->database,
                      "database (default: results/NAME.db, by the campaign's name)");
  command->add_option("--workers", options->workers, "worker processes here, or pilots of Slurm")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  command->add_option("--shard", options->shard,
                      "a part of the trials, for instance 2/4: the second of four; fatmc merge joins them");
  add_launch_options(*command, options->launch);
  add_spec_options(*command, options->changes);
  command->add_flag("--dry-run", options->dry_run, "list cells and dispersions, run nothing");
  command->add_flag("--retry-quarantined", options->retry_quarantined,
                    "try trials again that were given up because they killed their workers");
  command->add_flag("--verbose", options->verbose, "log what is decided and why to standard error");
  command->callback([options, &exit] { exit = run(*options); });
}

}  // namespace fatmc::cli
