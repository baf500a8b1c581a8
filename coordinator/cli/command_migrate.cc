// fatmc migrate: a database of an older program, brought to the present schema.
#include <cstdio>
#include <memory>

#include "coordinator/cli/command.h"
#include "coordinator/cli/database_use.h"
#include "coordinator/store/campaign_store.h"
#include "coordinator/store/schema.h"

namespace fatmc::cli {
namespace {

Exit migrate(const std::string& path) {
  const Result<int> found = CampaignStore::migrate(path);
  if (!found) return report(found.error());
  if (*found == kSchemaVersion) {
    std::printf("%s: has schema %d already\n", path.c_str(), kSchemaVersion);
  } else {
    std::printf("%s: from schema %d to %d; no result has changed\n", path.c_str(), *found, kSchemaVersion);
  }
  return Exit::done;
}

}  // namespace

void add_migrate_command(CLI::App& app, Exit& exit) {
  auto path = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("migrate", "brings a database of an older program up to date");
  command->footer(
      "In one transaction: it is done, or nothing has changed. `fatmc run` does the same when it resumes.\n"
      "Example: fatmc migrate results/coverage.db");
  command->add_option("DB", *path, "database")->required();
  command->callback([path, &exit] { exit = use_database(*path, [&] { return migrate(*path); }); });
}

}  // namespace fatmc::cli
