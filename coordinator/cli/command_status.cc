// fatmc status: how far a database is.
#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdio>
#include <memory>

#include "coordinator/cli/command.h"
#include "coordinator/store/campaign_store.h"
#include "core/base/text.h"

namespace fatmc::cli {
namespace {

void print_cells(const CampaignReader& reader) {
  SQLite::Statement cells(reader.database(), "SELECT cell, repetitions, stored, mean_trial_s FROM cells");
  const auto counts = reader.outcomes();
  while (cells.executeStep()) {
    const std::string name = cells.getColumn(0).getString();
    std::string outcomes;
    for (const OutcomeCount& count : counts) {
      if (count.cell == name) outcomes += "  " + std::to_string(count.trials) + " " + count.outcome;
    }
    const std::string mean =
        cells.getColumn(3).isNull()
            ? ""
            : "  " + significant(cells.getColumn(3).getDouble() * 1e3, 3) + " ms a trial";
    std::printf("  %s: %s of %s%s%s\n", name.c_str(), cells.getColumn(2).getString().c_str(),
                cells.getColumn(1).getString().c_str(), outcomes.c_str(), mean.c_str());
  }
}

void print_throughput(const CampaignReader& reader) {
  // Trials that ended within the last busy minute, so that pauses between runs do not count.
  SQLite::Statement last(
      reader.database(),
      "WITH ended AS (SELECT started_us / 1e6 + duration_ns / 1e9 AS t FROM trial), "
      "top AS (SELECT max(t) AS t FROM ended) "
      "SELECT count(*), max(ended.t) - min(ended.t), strftime('%Y-%m-%dT%H:%M:%SZ', top.t, 'unixepoch') "
      "FROM ended, top WHERE ended.t > top.t - 60");
  if (!last.executeStep() || last.getColumn(0).getInt64() < 2) return;
  const double span = last.getColumn(1).getDouble();
  if (!(span > 0.0)) return;
  std::printf("throughput: %s trials/s (the %s trials of the last minute of work, until %s)\n",
              significant(static_cast<double>(last.getColumn(0).getInt64() - 1) / span, 3).c_str(),
              last.getColumn(0).getString().c_str(), last.getColumn(2).getString().c_str());
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
  command->callback([path, &exit] { exit = print_status(*path); });
}

}  // namespace fatmc::cli
