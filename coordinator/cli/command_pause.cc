// fatmc pause, fatmc resume: from another terminal.
#include <cstdio>
#include <memory>

#include "coordinator/cli/command.h"
#include "coordinator/cli/database_use.h"
#include "coordinator/store/campaign_control.h"

namespace fatmc::cli {
namespace {

Exit set_paused(const std::string& path, bool paused) {
  Result<CampaignControl> control = CampaignControl::open(path);
  if (!control) return report(control.error());
  const bool before = control->tables().read().paused;
  control->tables().set_paused(paused);
  const bool running = has_coordinator(path);
  if (paused) {
    std::printf("%s: %s; %s; go on by: fatmc resume %s\n", path.c_str(),
                before ? "was paused already" : "paused",
                running ? "workers finish what they hold and get nothing new"
                        : "no coordinator is running, the next one will wait",
                path.c_str());
  } else {
    std::printf("%s: %s%s\n", path.c_str(), before ? "goes on" : "was not paused",
                running ? "" : "; no coordinator is running, start one by fatmc run or fatmc extend");
  }
  return Exit::done;
}

void add_command(CLI::App& app, Exit& exit, bool paused) {
  auto path = std::make_shared<std::string>();
  CLI::App* command =
      paused ? app.add_subcommand("pause", "stops handing out trials of a campaign, without ending it")
             : app.add_subcommand("resume", "goes on with a campaign that was paused");
  command->footer(std::string("From any terminal, while the campaign runs or not.\nExample: fatmc ") +
                  (paused ? "pause" : "resume") + " results/coverage.db");
  command->add_option("DB", *path, "database")->required();
  command->callback(
      [path, paused, &exit] { exit = use_database(*path, [&] { return set_paused(*path, paused); }); });
}

}  // namespace

void add_pause_command(CLI::App& app, Exit& exit) { add_command(app, exit, true); }
void add_resume_command(CLI::App& app, Exit& exit) { add_command(app, exit, false); }

}  // namespace fatmc::cli
