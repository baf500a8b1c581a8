// fatmc status: how far a database is.
#include <cstdio>
#include <memory>

#include "coordinator/cli/command.h"
#include "coordinator/cli/database_use.h"
#include "coordinator/store/campaign_store.h"
#include "core/base/text.h"

namespace fatmc::cli {
namespace {

void print_cells(const CampaignReader& reader) {
  const auto counts = reader.outcomes();
  for (const CellProgress& cell : reader.cells()) {
    std::string outcomes;
    for (const OutcomeCount& count : counts) {
      if (count.cell == cell.cell) outcomes += "  " + std::to_string(count.trials) + " " + count.outcome;
    }
    const std::string mean =
        cell.mean_trial_s ? "  " + significant(*cell.mean_trial_s * 1e3, 3) + " ms a trial" : "";
    std::printf("  %s: %llu of %llu%s%s\n", cell.cell.c_str(), static_cast<unsigned long long>(cell.stored),
                static_cast<unsigned long long>(cell.repetitions), outcomes.c_str(), mean.c_str());
  }
}

void print_throughput(const CampaignReader& reader) {
  const std::optional<Throughput> last = reader.throughput();
  if (!last) return;
  std::printf("throughput: %s trials/s (the %llu trials of the last minute of work, until %s)\n",
              significant(last->trials_per_s, 3).c_str(), static_cast<unsigned long long>(last->trials),
              last->until.c_str());
}

Exit print_status(const std::string& path) {
  const Result<CampaignReader> reader = CampaignReader::open(path);
  if (!reader) return report(reader.error());
  const CampaignSpec& spec = reader->spec();
  const std::uint64_t planned = spec.trial_count(), stored = reader->stored();
  std::printf("campaign %s (study %s, seed %llu, build %s)\n", spec.name.c_str(), spec.study.c_str(),
              static_cast<unsigned long long>(spec.seed), reader->build().substr(0, 12).c_str());
  std::printf("trials: %llu of %llu stored (%s %%)\n", static_cast<unsigned long long>(stored),
              static_cast<unsigned long long>(planned),
              fixed(100.0 * static_cast<double>(stored) / static_cast<double>(planned), 1).c_str());
  print_cells(*reader);
  print_throughput(*reader);
  return Exit::done;
}

}  // namespace

void add_status_command(CLI::App& app, Exit& exit) {
  auto path = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("status", "how far a campaign is: trials, outcomes, throughput");
  command->footer("May be called while the campaign runs.\nExample: fatmc status results/coverage.db");
  command->add_option("DB", *path, "database")->required();
  command->callback([path, &exit] { exit = use_database(*path, [&] { return print_status(*path); }); });
}

}  // namespace fatmc::cli
