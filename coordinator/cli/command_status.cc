// fatmc status: how far a database is.
#include <cstdio>
#include <memory>

#include "coordinator/cli/command.h"
#include "coordinator/cli/database_use.h"
#include "coordinator/state/precision_monitor.h"
#include "coordinator/store/campaign_control.h"
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

// How precise the answer is, by the trials that are stored without a gap.
void print_precision(const CampaignReader& reader) {
  const CampaignSpec& spec = reader.spec();
  if (!spec.precision) return;
  PrecisionMonitor monitor(*spec.precision, spec.cells.size());
  for (std::uint32_t cell = 0; cell < spec.cells.size(); ++cell) {
    reader.visit(cell, [&](const TrialRow& row) { monitor.add(row); }, {.arrays = false});
    const CellPrecision now = monitor.now(cell);
    if (now.values < 2) continue;
    std::printf("precision: %s: %s %s in [%s, %s] at %s %% after %llu trials", spec.cells[cell].name.c_str(),
                spec.precision->metric.c_str(), significant(now.mean, 4).c_str(),
                significant(now.interval.low, 4).c_str(), significant(now.interval.high, 4).c_str(),
                significant(100.0 * spec.precision->sequence.level, 4).c_str(),
                static_cast<unsigned long long>(now.trials));
    if (spec.precision->half_width) {
      const bool reached = 0.5 * (now.interval.high - now.interval.low) <= *spec.precision->half_width;
      std::printf("%s %s", reached ? ", precise enough: half-width at most" : ", half-width wanted",
                  significant(*spec.precision->half_width, 3).c_str());
    }
    std::printf("\n");
  }
}

void print_activity(const CampaignReader& reader, const std::string& path) {
  const ControlTables control = reader.control();
  std::printf("coordinator: %s%s\n", has_coordinator(path) ? "running" : "none",
              control.read().paused ? "; paused, fatmc resume goes on" : "");
  const auto trials = control.in_flight();
  if (trials.empty()) return;
  std::printf(
      "in flight for longer than a second: %zu leases, the longest for %s s (fatmc explain says where)\n",
      trials.size(), significant(trials.front().held_s, 3).c_str());
}

Exit print_status(const std::string& path, bool check) {
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
  print_precision(*reader);
  print_activity(*reader, path);
  return check && stored < planned ? Exit::partial : Exit::done;
}

}  // namespace

void add_status_command(CLI::App& app, Exit& exit) {
  auto path = std::make_shared<std::string>();
  auto check = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand(
      "status", "how far a campaign is: trials, outcomes, throughput, precision, coordinator");
  command->footer("May be called while the campaign runs.\nExample: fatmc status results/coverage.db");
  command->add_option("DB", *path, "database")->required();
  command->add_flag("--check", *check, "exit with 3 while trials are missing, for scripts that wait");
  command->callback(
      [path, check, &exit] { exit = use_database(*path, [&] { return print_status(*path, *check); }); });
}

}  // namespace fatmc::cli
