// fatmc merge: shards of one campaign become one database.
#include <unistd.h>

#include <cstdio>
#include <memory>

#include "coordinator/cli/command.h"
#include "coordinator/cli/database_use.h"
#include "coordinator/store/shard_merge.h"

namespace fatmc::cli {
namespace {

struct MergeOptions {
  std::string output;
  std::vector<std::string> shards;
};

Exit merge(const MergeOptions& options) {
  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  const Result<MergeReport> merged = merge_shards(options.output, options.shards, [&](std::size_t shard) {
    if (terminal) {
      std::fprintf(stderr, "fatmc: shard %zu of %zu: %s\n", shard + 1, options.shards.size(),
                   options.shards[shard].c_str());
    }
  });
  if (!merged) return report(merged.error());
  std::printf("%llu trials added, %llu were there already\n%llu of %llu trials\ndatabase: %s\n",
              static_cast<unsigned long long>(merged->added),
              static_cast<unsigned long long>(merged->duplicates),
              static_cast<unsigned long long>(merged->stored),
              static_cast<unsigned long long>(merged->planned), options.output.c_str());
  return Exit::done;
}

}  // namespace

void add_merge_command(CLI::App& app, Exit& exit) {
  auto options = std::make_shared<MergeOptions>();
  CLI::App* command = app.add_subcommand("merge", "joins databases of one campaign that were filled apart");
  command->footer(
      "Trials that several shards have are taken once; two different results of one trial are refused. All "
      "or "
      "nothing. The output has the digest of a single run.\n"
      "Example: fatmc run SPEC --shard 1/2 --db a.db    (here)\n"
      "         fatmc run SPEC --shard 2/2 --db b.db    (anywhere else)\n"
      "         fatmc merge all.db a.db b.db");
  command->add_option("OUT", options->output, "database to make or to add to")->required();
  command->add_option("SHARD", options->shards, "databases to read")->required();
  command->callback(
      [options, &exit] { exit = use_database(options->output, [&] { return merge(*options); }); });
}

}  // namespace fatmc::cli
