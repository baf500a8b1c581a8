#include "coordinator/cli/campaign_session.h"

#include <spdlog/cfg/env.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>

#include "coordinator/cli/campaign_watch.h"
#include "coordinator/cli/database_use.h"
#include "coordinator/cli/progress_line.h"
#include "coordinator/cli/session_summary.h"
#include "coordinator/server/campaign_server.h"
#include "coordinator/server/local_workers.h"
#include "coordinator/state/campaign_state.h"
#include "coordinator/store/campaign_store.h"
#include "core/base/build_hash.h"
#include "proto/key_files.h"

namespace fatmc::cli {
namespace {

constexpr std::chrono::milliseconds kByePatience{1500};
constexpr std::chrono::milliseconds kLauncherPatience{10'000};

// results/last names the databases of the last run, a path a line, for `fatmc tables` without arguments.
// A convenience, so that failing is no failure of the run.
void write_last(const SessionOptions& options) {
  const std::string fresh = "results/last.new";
  std::error_code error;
  std::filesystem::create_directories("results", error);
  std::ofstream out(fresh);
  std::vector<std::string> databases = options.earlier;
  databases.push_back(options.database);
  for (const std::string& path : databases)
    out << std::filesystem::absolute(path).lexically_normal().string() << "\n";
  out.close();
  if (!error && !out) error = std::error_code(errno, std::generic_category());
  if (!error) std::filesystem::rename(fresh, "results/last", error);
  if (error) {
    std::fprintf(
        stderr, "fatmc: warning: results/last: cannot be written (%s), name the database to `fatmc tables`\n",
        error.message().c_str());
  }
}

void report_counters(const CampaignState& state, std::uint64_t malformed) {
  const StateCounters& c = state.counters();
  if (c.conflicts > 0) {
    std::fprintf(
        stderr,
        "fatmc: ALARM: %llu results differ from what is stored for the same trial; the stored ones were "
        "kept, but trials of this build are not reproducible\n",
        static_cast<unsigned long long>(c.conflicts));
  }
  spdlog::info(
      "duplicates {}, conflicts {}, reclaimed leases {}, copies {}, quarantined {}, refused {}, foreign {}, "
      "out of "
      "plan {}, malformed {}",
      c.duplicates, c.conflicts, c.reclaimed, c.copied, c.quarantined, c.refused_hellos, c.foreign,
      c.out_of_plan, malformed);
}

// What a session needs of this machine, had before the database is touched. In this order: an ipc path is
// taken from whoever has it, so that only the holder of the lock may bind.
struct Place {
  std::string worker_program;
  std::optional<WorkerKeys> worker_keys;
  WriterLock lock;
  BoundSocket socket;
};

Result<Place> take_place(const SessionOptions& options) {
  std::string program;
  if (options.workers > 0) {
    Result<std::string> found = worker_program_beside_this();
    if (!found) return fail(found.error());
    program = std::move(*found);
  }
  std::optional<CoordinatorKeys> keys;
  std::optional<WorkerKeys> worker_keys;
  if (!options.keys.empty()) {
    const Result<CoordinatorKeys> found = read_coordinator_keys(options.keys);
    if (!found) return fail(found.error());
    keys = *found;
  } else if (options.workers > 0) {
    const RunKeys made = make_run_keys();
    keys = made.coordinator;
    worker_keys = made.worker;
  }
  Result<WriterLock> lock = CampaignStore::lock(options.database);
  if (!lock) return fail(lock.error());
  Result<BoundSocket> socket = BoundSocket::bind(options.endpoint, keys);
  if (!socket) return fail(socket.error());
  return Place{std::move(program), std::move(worker_keys), std::move(*lock), std::move(*socket)};
}

std::vector<PlanCell> plan_of_shard(const CampaignSpec& spec, const SessionOptions& options,
                                    CampaignStore& store) {
  std::vector<PlanCell> plan =
      store.plan(spec, options.retry_quarantined ? StoredTrials::results : StoredTrials::all);
  for (PlanCell& cell : plan) {
    const auto [first, last] = options.shard.range(cell.repetitions);
    cell.elsewhere.insert(0, first);
    cell.elsewhere.insert(last, cell.repetitions);
  }
  return plan;
}

// Apart from those of the coordinator before, whatever became of the clock meanwhile.
std::uint64_t random_lease() {
  std::random_device device;
  return (std::uint64_t{device()} << 30) + 1;
}

// The serving part; returns nothing when all is stored.
std::optional<Exit> serve(const CampaignSpec& spec, const SessionOptions& options, Place place,
                          CampaignStore& store) {
  StateOptions state_options;
  state_options.first_lease = random_lease();
  CampaignState state(plan_of_shard(spec, options, store), Welcome{spec.identity(), spec.tree, 0},
                      build_hash(), state_options);
  CampaignWatch watch(spec, options.database, options.shard.count > 1, state, store);
  if (state.finished()) {
    write_last(options);
    return std::nullopt;
  }
  const std::uint64_t planned_at_first = state.planned();
  const std::string endpoint = place.socket.endpoint();
  CampaignServer server(std::move(place.socket), {}, state, store);
  std::unique_ptr<Launcher> launcher;
  if (options.launcher) {
    Result<std::unique_ptr<Launcher>> made = options.launcher(endpoint);
    if (!made) return report(made.error());
    launcher = std::move(*made);
  } else if (options.workers == 0) {
    std::fprintf(stderr, "fatmc: %llu trials to do; start workers by: fatmc-worker --connect %s%s\n",
                 static_cast<unsigned long long>(state.planned() - state.stored()), endpoint.c_str(),
                 options.keys.empty() ? "" : (" " + shell_line({"--keys", options.keys})).c_str());
  }
  LocalWorkerOptions worker_options;
  worker_options.program = place.worker_program;
  worker_options.keys = place.worker_keys;
  worker_options.endpoint = endpoint;
  worker_options.count =
      static_cast<unsigned>(std::min<std::uint64_t>(options.workers, state.planned() - state.stored()));
  worker_options.verbose = options.verbose;
  LocalWorkers workers(worker_options);
  ProgressLine progress;
  progress.show(watch.progress());
  workers.start();
  ServerHooks hooks;
  bool last_is_written = false;
  hooks.on_tick = [&] {
    watch.on_tick(server);
    progress.show(watch.progress());
    if (launcher) {
      launcher->tick({state.planned() - state.stored(), state.stored(), state.workers().size()},
                     std::chrono::steady_clock::now());
    }
    if (last_is_written || state.stored() == 0) return;
    last_is_written = true;
    write_last(options);
  };
  hooks.on_committed = [&](const StoreRequest& request, const StoreReport& report) {
    watch.on_committed(request, report, server);
  };
  hooks.on_child = [&] {
    for (const EndedProcess& ended : workers.reap(state.counters().results))
      server.on_process_ended(ended.pid, ended.how);
  };
  hooks.failure = [&] { return launcher ? launcher->failure() : workers.failure(); };
  const ServerEnd end = server.run(hooks);
  progress.finish(watch.progress());
  watch.on_end(end == ServerEnd::failed);
  if (!last_is_written && state.stored() > 0) write_last(options);
  workers.stop(kByePatience);
  if (launcher) launcher->stop(kLauncherPatience);
  report_counters(state, server.malformed());
  if (end == ServerEnd::finished) return std::nullopt;
  // Of a plan that `fatmc extend` has made longer, the command of this run would do a part.
  const bool is_extended = state.planned() > planned_at_first && options.workers > 0 && !options.launcher;
  const std::string resume =
      "; what is stored stays, go on by: " + (is_extended ? extend_command(options) : options.resume_command);
  if (end == ServerEnd::interrupted) {
    std::fprintf(stderr, "fatmc: stopped with %llu of %llu trials stored%s\n",
                 static_cast<unsigned long long>(state.stored()),
                 static_cast<unsigned long long>(state.planned()), resume.c_str());
    return Exit::partial;
  }
  std::fprintf(stderr, "fatmc: %s%s%s%s\n", hooks.failure().c_str(), state.last_refusal().empty() ? "" : ": ",
               state.last_refusal().c_str(), resume.c_str());
  return Exit::failed;
}

}  // namespace

std::string default_database(const CampaignSpec& spec, const Shard& shard) {
  if (shard.count == 1) return "results/" + spec.name + ".db";
  return "results/" + spec.name + "." + std::to_string(shard.number) + "of" + std::to_string(shard.count) +
         ".db";
}

std::string shell_line(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) {
    if (!out.empty()) out += ' ';
    out += shell_word(word);
  }
  return out;
}

Exit run_session(const CampaignSpec& spec, const SessionOptions& options) {
  if (spdlog::get("coordinator") == nullptr)
    spdlog::set_default_logger(spdlog::stderr_logger_mt("coordinator"));
  spdlog::set_level(options.verbose ? spdlog::level::info : spdlog::level::warn);
  spdlog::cfg::load_env_levels();  // SPDLOG_LEVEL=debug: every message, too
  {
    const BlockedSignals blocked;
    Result<Place> place = take_place(options);
    if (!place) return report(place.error());
    std::optional<Exit> exit;
    const Exit opened = use_database(options.database, [&] {
      Result<CampaignStore> store =
          CampaignStore::open(std::move(place->lock), options.database, spec, build_hash());
      if (!store) return report(store.error());
      exit = serve(spec, options, std::move(*place), *store);
      return Exit::done;
    });
    if (opened != Exit::done) return opened;
    if (exit) return *exit;
  }
  return use_database(options.database, [&] {
    const Exit printed = print_summary(options.database);
    if (printed == Exit::done && options.shard.count == 1) report_rest(options);
    return printed == Exit::done ? report_quarantine(options) : printed;
  });
}

}  // namespace fatmc::cli
