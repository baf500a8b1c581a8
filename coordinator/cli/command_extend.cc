// fatmc extend: more trials of a campaign, without its spec.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <set>
#include <thread>

#include "coordinator/cli/campaign_session.h"
#include "coordinator/cli/command.h"
#include "coordinator/cli/database_use.h"
#include "coordinator/cli/trial_name.h"
#include "coordinator/store/campaign_control.h"
#include "coordinator/store/campaign_store.h"
#include "core/base/build_hash.h"

namespace fatmc::cli {
namespace {

struct ExtendOptions {
  std::string database, cell;
  std::int64_t trials = 0, add = 0;
  unsigned workers = std::max(1U, std::thread::hardware_concurrency());
  bool verbose = false, retry_quarantined = false;
};

// The spec of the database with the numbers of repetitions that are wanted.
Result<CampaignSpec> extended_spec(const CampaignReader& reader, const ExtendOptions& options) {
  CampaignSpec spec = reader.spec();
  if (options.trials == 0 && options.add == 0) return spec;
  std::set<std::uint32_t> stopped;
  for (const StopDecision& stop : reader.control().stops()) stopped.insert(stop.cell);
  std::uint32_t first = 0, last = static_cast<std::uint32_t>(spec.cells.size());
  if (!options.cell.empty()) {
    const Result<std::uint32_t> cell = find_cell(spec, options.cell, "--cell");
    if (!cell) return fail(cell.error());
    first = *cell;
    last = first + 1;
  }
  bool any = false;
  for (std::uint32_t i = first; i < last; ++i) {
    Cell& cell = spec.cells[i];
    if (stopped.contains(i)) {
      if (options.cell.empty()) continue;
      return fail(Error{"", 0, "--cell",
                        "\"" + cell.name +
                            "\" ended since it is precise enough; give [stop] a smaller "
                            "half_width and run the spec again"});
    }
    const std::uint64_t wanted = options.add > 0 ? cell.repetitions + static_cast<std::uint64_t>(options.add)
                                                 : static_cast<std::uint64_t>(options.trials);
    if (wanted <= cell.repetitions) continue;
    cell.repetitions = wanted;
    any = true;
  }
  if (any) return spec;
  return fail(Error{"", 0, options.add > 0 ? "--add" : "--trials",
                    stopped.empty() ? "no cell has fewer trials than that, write a larger number"
                                    : "every cell has as many trials, or is precise enough"});
}

Exit tell_coordinator(const CampaignSpec& spec, const std::string& path) {
  Result<CampaignControl> control = CampaignControl::open(path);
  if (!control) return report(control.error());
  for (std::uint32_t cell = 0; cell < spec.cells.size(); ++cell) {
    control->tables().set_repetitions(cell, spec.cells[cell].repetitions);
  }
  std::printf("%s: %llu trials planned; the coordinator that is running takes them up\n", path.c_str(),
              static_cast<unsigned long long>(spec.trial_count()));
  return Exit::done;
}

Exit extend(const ExtendOptions& options) {
  Result<CampaignSpec> spec = fail("not read");
  {
    const Result<CampaignReader> reader = CampaignReader::open(options.database);
    if (!reader) return report(reader.error());
    spec = extended_spec(*reader, options);
    if (!spec) return report(spec.error());
    if (has_coordinator(options.database)) return tell_coordinator(*spec, options.database);
    if (reader->control().read().paused) {
      std::fprintf(stderr, "fatmc: the campaign is paused; fatmc resume %s goes on\n",
                   options.database.c_str());
    }
  }
  SessionOptions session;
  session.database = options.database;
  session.workers = options.workers;
  session.verbose = options.verbose;
  session.retry_quarantined = options.retry_quarantined;
  session.resume_command =
      shell_line({"fatmc", "extend", options.database, "--workers", std::to_string(options.workers)});
  return run_session(*spec, session);
}

}  // namespace

void add_extend_command(CLI::App& app, Exit& exit) {
  auto options = std::make_shared<ExtendOptions>();
  CLI::App* command = app.add_subcommand("extend", "more trials of a campaign; what is stored stays");
  command->footer(
      "Needs no spec: the database holds it. Where a coordinator is running on the database, it takes the "
      "trials up; else "
      "they are run here. Without --trials and --add, what is planned and missing is run.\n"
      "Example: fatmc extend results/coverage.db --trials 200");
  command->add_option("DB", options->database, "database")->required();
  auto* trials = command->add_option("--trials", options->trials, "repetitions of each cell in all")
                     ->check(CLI::Range(std::int64_t{1}, std::int64_t{1'000'000'000}));
  command->add_option("--add", options->add, "repetitions of each cell on top of those planned")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1'000'000'000}))
      ->excludes(trials);
  command->add_option("--cell", options->cell, "this cell alone");
  command->add_option("--workers", options->workers, "worker processes")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  command->add_flag("--retry-quarantined", options->retry_quarantined,
                    "try trials again that were given up because they killed their workers");
  command->add_flag("--verbose", options->verbose, "log what is decided and why to standard error");
  command->callback(
      [options, &exit] { exit = use_database(options->database, [&] { return extend(*options); }); });
}

}  // namespace fatmc::cli
