#include "coordinator/cli/session_summary.h"

#include <cstdio>
#include <map>
#include <set>

#include "campaigns/registry_summaries.h"
#include "coordinator/report/tables.h"
#include "coordinator/store/campaign_store.h"
#include "core/base/text.h"

namespace fatmc::cli {
namespace {

// How each cell ended where [stop] says when it is precise enough.
void print_stops(const CampaignReader& reader) {
  const CampaignSpec& spec = reader.spec();
  if (!spec.precision || !spec.precision->half_width) return;
  std::map<std::uint32_t, StopDecision> stops;
  for (const StopDecision& stop : reader.control().stops()) stops.emplace(stop.cell, stop);
  for (std::uint32_t cell = 0; cell < spec.cells.size(); ++cell) {
    const auto stop = stops.find(cell);
    if (stop == stops.end() && reader.stored() < spec.trial_count()) continue;  // a shard, or not yet done
    if (stop == stops.end()) {
      std::printf("%s: %s is not known to within %s after all %llu trials; give the cell more\n",
                  spec.cells[cell].name.c_str(), spec.precision->metric.c_str(),
                  significant(*spec.precision->half_width, 3).c_str(),
                  static_cast<unsigned long long>(spec.cells[cell].repetitions));
      continue;
    }
    const StopDecision& d = stop->second;
    std::printf("%s: precise enough after %llu trials, %s %s in [%s, %s] at %s %%\n",
                spec.cells[cell].name.c_str(), static_cast<unsigned long long>(d.repetitions),
                d.metric.c_str(), significant(d.mean, 4).c_str(), significant(d.low, 4).c_str(),
                significant(d.high, 4).c_str(), significant(100.0 * d.level, 4).c_str());
  }
}

void print_outcomes(const CampaignReader& reader, const std::string& database) {
  std::map<std::string, std::uint64_t> counts;
  std::uint64_t stored = 0;
  for (const OutcomeCount& count : reader.outcomes()) {
    counts[count.outcome] += count.trials;
    stored += count.trials;
  }
  std::string text = std::to_string(counts["ok"]) + " ok";
  for (const auto& [outcome, trials] : counts) {
    if (outcome != "ok") text += ", " + std::to_string(trials) + " " + outcome;
  }
  std::printf("%llu of %llu trials: %s\ndatabase: %s\n", static_cast<unsigned long long>(stored),
              static_cast<unsigned long long>(reader.spec().trial_count()), text.c_str(), database.c_str());
  std::fflush(stdout);
}

}  // namespace

Exit print_summary(const std::string& database) {
  Result<CampaignReader> reader = CampaignReader::open(database);
  if (!reader) return report(reader.error());
  print_outcomes(*reader, database);
  print_stops(*reader);
  const SummaryStudy* study = find_summary_study(reader->spec().study);
  if (study == nullptr) return Exit::done;
  const auto tables = study->tables(reader->spec(), reader->rows());
  if (!tables) {
    report(tables.error());
    return Exit::failed;
  }
  // Curves take many rows: they wait for `fatmc tables`.
  std::vector<TableRow> shown;
  std::set<std::string> curves;
  for (const TableRow& row : *tables) {
    if (row.table.starts_with("Fig."))
      curves.insert(row.table);
    else
      shown.push_back(row);
  }
  std::printf("\n");
  if (tables->empty()) {
    std::printf("no trial gave an estimate, so there is no table; fatmc query %s --view failures tells why\n",
                database.c_str());
    return Exit::done;
  }
  print_tables(shown, TableFormat::text);
  for (const std::string& name : curves) {
    std::printf("\n%s: fatmc tables %s --only \"%s\"\n", name.c_str(), database.c_str(), name.c_str());
  }
  return Exit::done;
}

std::string extend_command(const SessionOptions& options) {
  return shell_line({"fatmc", "extend", options.database});
}

void report_rest(const SessionOptions& options) {
  const Result<CampaignReader> reader = CampaignReader::open(options.database);
  if (!reader || reader->stored() >= reader->spec().trial_count()) return;
  std::fprintf(stderr,
               "fatmc: all trials that this run asked for are stored; the database plans %llu more, by an "
               "earlier run or fatmc extend, which this computes: %s\n",
               static_cast<unsigned long long>(reader->spec().trial_count() - reader->stored()),
               extend_command(options).c_str());
}

// Trials that were given up make a campaign partial.
Exit report_quarantine(const SessionOptions& options) {
  Result<CampaignReader> reader = CampaignReader::open(options.database);
  if (!reader) return report(reader.error());
  std::uint64_t given_up = 0;
  for (const OutcomeCount& count : reader->outcomes())
    if (count.outcome == kQuarantined) given_up += count.trials;
  if (given_up == 0) return Exit::done;
  std::fprintf(
      stderr,
      "fatmc: %llu trials are quarantined, since each killed its worker three times; fatmc query %s --view "
      "failures tells how, and this tries them again: %s --retry-quarantined\n",
      static_cast<unsigned long long>(given_up), options.database.c_str(), options.resume_command.c_str());
  return Exit::partial;
}

}  // namespace fatmc::cli
