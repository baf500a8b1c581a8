// fatmc digest: one line that is the same for the same results.
#include <cstdio>
#include <memory>

#include "coordinator/cli/command.h"
#include "coordinator/cli/database_use.h"
#include "coordinator/store/campaign_store.h"

namespace fatmc::cli {
namespace {

Exit print_digest(const std::string& path) {
  const Result<CampaignReader> reader = CampaignReader::open(path);
  if (!reader) return report(reader.error());
  std::printf("%s\n", reader->digest().c_str());
  const std::uint64_t stored = reader->stored(), planned = reader->spec().trial_count();
  if (stored < planned) {
    std::fprintf(stderr, "fatmc: note: %s: partial, %llu of %llu trials are stored: the digest is theirs alone\n",
                 path.c_str(), static_cast<unsigned long long>(stored), static_cast<unsigned long long>(planned));
  }
  return Exit::done;
}

}  // namespace

void add_digest_command(CLI::App& app, Exit& exit) {
  auto path = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("digest", "SHA-256 of all results of a database, in the order of trials");
  command->footer(
      "Times, hosts and attempts are left out: whoever computed them, the same results give the same line.\n"
      "Example: fatmc digest results/coverage.db");
  command->add_option("DB", *path, "database")->required();
  command->callback([path, &exit] { exit = use_database(*path, [&] { return print_digest(*path); }); });
}

}  // namespace fatmc::cli
