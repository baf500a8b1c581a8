// fatmc explain: why trials are missing or not ok, and what to do about it.
#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdio>
#include <ctime>
#include <memory>

#include "coordinator/cli/campaign_session.h"
#include "coordinator/cli/command.h"
#include "coordinator/cli/database_use.h"
#include "coordinator/cli/trial_name.h"
#include "coordinator/state/campaign_state.h"
#include "coordinator/state/index_ranges.h"
#include "coordinator/store/campaign_control.h"
#include "coordinator/store/campaign_store.h"
#include "coordinator/store/schema.h"
#include "core/base/text.h"

namespace fatmc::cli {
namespace {

struct Explanation {
  const CampaignReader& reader;
  std::string path;
  bool running;
  [[nodiscard]] const CampaignSpec& spec() const { return reader.spec(); }
};

// What an outcome means, and what a user can do.
std::string advice(const std::string& outcome) {
  if (outcome == "diverged") {
    return "the flight left the model's [validity] or became infinite; a result like any other, counted in "
           "every "
           "denominator. Look at the flight by replay -o; smaller amplitudes, less turbulence or a wider "
           "[validity] avoid it";
  }
  if (outcome == "singular") {
    return "the response of the inputs to the references has no inverse at some line; more lines a window "
           "(n_e), more "
           "excitation or independent references avoid it";
  }
  if (outcome == "infeasible") {
    return "the drawn parameters make a spec that cannot be flown; a truncated law keeps them inside their "
           "range";
  }
  if (outcome == kQuarantined) {
    return "its worker ended each time that it was tried, so that it was given up; fatmc replay computes it "
           "in the "
           "foreground, fatmc extend --retry-quarantined tries it again";
  }
  return "fatmc replay computes it again";
}

std::string plural(std::uint64_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

std::string utc_text(std::uint64_t unix_us) {
  const auto seconds = static_cast<std::time_t>(unix_us / 1'000'000);
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

IndexRanges missing_of(const CampaignReader& reader, std::uint32_t cell) {
  IndexRanges missing;
  missing.insert(0, reader.spec().cells[cell].repetitions);
  SQLite::Statement stored(reader.database(),
                           "SELECT repetition FROM trial WHERE id BETWEEN ? AND ? ORDER BY id");
  stored.bind(1, trial_id({cell, 0}));
  stored.bind(2, trial_id({cell + 1, 0}) - 1);
  while (stored.executeStep()) missing.erase(static_cast<std::uint64_t>(stored.getColumn(0).getInt64()));
  return missing;
}

std::string ranges_text(const IndexRanges& ranges) {
  constexpr std::size_t kShown = 5;
  std::string out;
  std::size_t shown = 0;
  for (const auto& [first, last] : ranges.ranges()) {
    if (shown++ == kShown) return out + ", ...";
    out += (out.empty() ? "" : ", ") + std::to_string(first);
    if (last > first + 1) out += " to " + std::to_string(last - 1);
  }
  return out;
}

void print_in_flight(const Explanation& at) {
  const ControlTables control = at.reader.control();
  for (const TrialsInFlight& trial : control.in_flight()) {
    std::string span = trial_name(at.spec(), {trial.cell, trial.first});
    if (trial.missing > 1)
      span += " and " + std::to_string(trial.missing - 1) + " more below " + std::to_string(trial.last);
    std::printf("  %s: held by process %u on %s for %s s, attempt %u (as of %s)\n", span.c_str(), trial.pid,
                trial.host.c_str(), significant(trial.held_s, 3).c_str(), trial.attempts,
                control.in_flight_reported().c_str());
    if (!at.running) {
      std::printf(
          "    the run ended with it out: if the process crashed there, `fatmc replay %s %s` shows how\n",
          at.path.c_str(), shell_line({trial_name(at.spec(), {trial.cell, trial.first})}).c_str());
    }
  }
}

void print_missing(const Explanation& at) {
  bool any = false;
  for (std::uint32_t cell = 0; cell < at.spec().cells.size(); ++cell) {
    const IndexRanges missing = missing_of(at.reader, cell);
    if (missing.empty()) continue;
    any = true;
    std::printf("  %s: %s missing: %s\n", at.spec().cells[cell].name.c_str(),
                plural(missing.size(), "trial").c_str(), ranges_text(missing).c_str());
  }
  if (!any) return;
  if (at.reader.control().read().paused) {
    std::printf("  the campaign is paused, go on by: fatmc resume %s\n", at.path.c_str());
  }
  if (!at.running) std::printf("  no coordinator is running, go on by: fatmc extend %s\n", at.path.c_str());
}

void print_failures(const Explanation& at) {
  SQLite::Statement rows(at.reader.database(),
                         "SELECT cell.name, t.outcome, count(*), min(t.repetition), t.detail FROM trial t "
                         "JOIN cell ON cell.id = t.cell WHERE t.outcome <> 'ok' GROUP BY t.cell, t.outcome "
                         "ORDER BY t.cell, t.outcome");
  while (rows.executeStep()) {
    const std::string cell = rows.getColumn(0).getString(), outcome = rows.getColumn(1).getString();
    const auto count = static_cast<std::uint64_t>(rows.getColumn(2).getInt64());
    std::printf("  %s: %s %s, the first is %s/%lld (%s)\n    %s\n", cell.c_str(),
                plural(count, "trial").c_str(), outcome.c_str(), cell.c_str(),
                static_cast<long long>(rows.getColumn(3).getInt64()), rows.getColumn(4).getString().c_str(),
                advice(outcome).c_str());
  }
}

void print_retries(const Explanation& at) {
  SQLite::Statement rows(
      at.reader.database(),
      "SELECT cell.name, t.repetition, t.attempts, count(*) OVER () FROM trial t JOIN cell ON "
      "cell.id = t.cell WHERE t.attempts > 1 ORDER BY t.attempts DESC, t.id LIMIT 1");
  if (!rows.executeStep()) return;
  std::printf(
      "  %s tried more than once, %s/%lld most often: %d times; workers that died, fell silent or were cut "
      "off\n",
      plural(static_cast<std::uint64_t>(rows.getColumn(3).getInt64()), "trial").c_str(),
      rows.getColumn(0).getString().c_str(), static_cast<long long>(rows.getColumn(1).getInt64()),
      rows.getColumn(2).getInt());
}

void explain_campaign(const Explanation& at) {
  const std::uint64_t stored = at.reader.stored(), planned = at.spec().trial_count();
  std::printf("%s: %llu of %s stored; %s\n", at.path.c_str(), static_cast<unsigned long long>(stored),
              plural(planned, "trial").c_str(),
              at.running ? "a coordinator is running" : "no coordinator is running");
  print_missing(at);
  print_in_flight(at);
  print_failures(at);
  print_retries(at);
}

void explain_stored(const Explanation& at, const StoredRow& trial, const std::string& name) {
  const TrialRow& row = trial.computed.row;
  std::printf("%s: %s%s\n", name.c_str(), row.outcome.c_str(),
              row.detail.empty() ? "" : (": " + row.detail).c_str());
  std::printf("  computed on %s (process %u), begun %s, in %s s; leased %s\n", trial.host.c_str(), trial.pid,
              utc_text(trial.computed.started_us).c_str(),
              significant(1e-9 * static_cast<double>(trial.computed.duration_ns), 3).c_str(),
              plural(trial.attempts, "time").c_str());
  std::printf("  seed %llu, build %s, content hash %s\n", static_cast<unsigned long long>(at.spec().seed),
              at.reader.build().substr(0, 12).c_str(), hex(trial.computed.hash).substr(0, 16).c_str());
  for (const auto& [metric, value] : row.metrics) {
    if (metric.starts_with(kDrawPrefix)) {
      std::printf("  drawn: %s = %s\n", metric.substr(kDrawPrefix.size()).c_str(), shortest(value).c_str());
    }
  }
  if (row.outcome != "ok") std::printf("  %s\n", advice(row.outcome).c_str());
  std::printf("  again, with its flight: fatmc replay %s %s -o RECORD.csv\n", at.path.c_str(),
              shell_line({name}).c_str());
}

void explain_missing(const Explanation& at, TrialKey key, const std::string& name) {
  if (key.repetition >= at.spec().cells[key.cell].repetitions) {
    std::printf(
        "%s: beyond the plan of %llu repetitions\n  it can be had by: fatmc extend %s --cell %s --trials "
        "%llu\n",
        name.c_str(), static_cast<unsigned long long>(at.spec().cells[key.cell].repetitions), at.path.c_str(),
        shell_line({at.spec().cells[key.cell].name}).c_str(),
        static_cast<unsigned long long>(key.repetition + 1));
    return;
  }
  std::printf("%s: planned and not stored\n", name.c_str());
  bool held = false;
  for (const TrialsInFlight& trial : at.reader.control().in_flight()) {
    held = held || (trial.cell == key.cell && trial.first <= key.repetition && key.repetition < trial.last);
  }
  if (held) print_in_flight(at);
  if (!held && at.running) std::printf("  it waits for a worker, or one has had it for less than a second\n");
  if (at.reader.control().read().paused)
    std::printf("  the campaign is paused, go on by: fatmc resume %s\n", at.path.c_str());
  if (!at.running) std::printf("  no coordinator is running, go on by: fatmc extend %s\n", at.path.c_str());
  std::printf("  at once, in the foreground: fatmc replay %s %s\n", at.path.c_str(),
              shell_line({name}).c_str());
}

Exit explain(const std::string& path, const std::string& trial) {
  const Result<CampaignReader> reader = CampaignReader::open(path);
  if (!reader) return report(reader.error());
  const Explanation at{*reader, path, has_coordinator(path)};
  if (trial.empty()) {
    explain_campaign(at);
    return Exit::done;
  }
  const Result<TrialKey> key = parse_trial(reader->spec(), trial);
  if (!key) return report(key.error());
  const std::string name = trial_name(reader->spec(), *key);
  if (const auto stored = reader->trial(*key)) {
    explain_stored(at, *stored, name);
  } else {
    explain_missing(at, *key, name);
  }
  return Exit::done;
}

}  // namespace

void add_explain_command(CLI::App& app, Exit& exit) {
  auto path = std::make_shared<std::string>(), trial = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("explain", "why trials are missing or not ok, and what to do");
  command->footer(
      "Without TRIAL: all that is missing, stuck, failed or was tried more than once.\n"
      "Example: fatmc explain results/coverage.db nonlinear/3");
  command->add_option("DB", *path, "database")->required();
  command->add_option("TRIAL", *trial, "CELL/REPETITION, or REPETITION where there is one cell");
  command->callback(
      [path, trial, &exit] { exit = use_database(*path, [&] { return explain(*path, *trial); }); });
}

}  // namespace fatmc::cli
