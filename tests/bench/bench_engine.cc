// How much work the engine itself is: campaigns through real worker processes, sockets with CURVE and a
// database with synchronous=FULL, as `fatmc run` has them.
//
// acked_per_s: empty trials stored, committed and acknowledged a second of wall time.
// coordinator_us_per_trial: processor time of the coordinator's process, a trial.
// efficiency_10ms: time that workers spent in trials, over workers times wall time from the first trial's
// start to
//   the commit of the last.
// resume_million_s: from a closed database of a million trials to a coordinator that is ready to lease.
// aggregate_million_s: views outcomes and scalars of that database.
// coordinator_growth_b_per_trial: resident memory after 1,000,000 trials less that after 100,000, a trial.
#include <SQLiteCpp/SQLiteCpp.h>
#include <benchmark/benchmark.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>

#include "coordinator/server/campaign_server.h"
#include "coordinator/server/local_workers.h"
#include "coordinator/store/campaign_store.h"
#include "core/base/check.h"
#include "core/base/build_hash.h"

namespace fatmc {
namespace {

constexpr std::int64_t kMillion = 1'000'000;

CampaignSpec test_trials(std::int64_t repetitions, std::int64_t work = 0) {
  const auto value = [](auto content) { return Tree{std::move(content), "bench", 1}; };
  Tree campaign = value(Tree::Table{}), cell = campaign, tree = campaign;
  campaign.set("study", value(std::string("engine_test")));
  campaign.set("seed", value(std::int64_t{1}));
  cell.set("name", value(std::string("empty")));
  cell.set("repetitions", value(repetitions));
  if (work > 0) cell.set("work", value(work));
  tree.set("campaign", campaign);
  tree.set("cell", value(Tree::Array{{cell}}));
  return *decode_campaign(tree);
}

double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  double pages = 0.0, resident = 0.0;
  statm >> pages >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

/// A folder that is gone with its owner.
class Folder {
 public:
  Folder()
      : path_(std::filesystem::temp_directory_path() /
              ("fatmc_bench_" + std::to_string(::getpid()) + "_" + std::to_string(++count_))) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] std::string file(const char* name) const { return (path_ / name).string(); }

 private:
  static inline int count_ = 0;
  std::filesystem::path path_;
};

struct CampaignRun {
  double wall_s = 0.0, processor_s = 0.0, resident_b = 0.0, finished_s = 0.0;
};

double unix_time() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

CampaignRun run_campaign(const std::string& database, const CampaignSpec& spec, unsigned workers_wanted) {
  auto store = CampaignStore::open(database, spec, build_hash());
  FATMC_CHECK(store.has_value(), "the bench's database can be made");
  CampaignState state(store->plan(spec), Welcome{spec.identity(), spec.tree, 0}, build_hash());
  const RunKeys keys = make_run_keys();
  Result<BoundSocket> socket = BoundSocket::bind("tcp://127.0.0.1:*", keys.coordinator);
  FATMC_CHECK(socket.has_value(), "the bench's port can be had");
  LocalWorkerOptions options;
  options.program = FATMC_TEST_WORKER;
  options.endpoint = socket->endpoint();
  options.keys = keys.worker;
  options.count = workers_wanted;
  CampaignServer server(std::move(*socket), {}, state, *store);
  LocalWorkers workers(options);
  CampaignRun run;
  const double before = processor_seconds();
  const auto begin = std::chrono::steady_clock::now();
  workers.start();
  ServerHooks hooks;
  hooks.failure = [&] { return workers.failure(); };
  FATMC_CHECK(server.run(hooks) == ServerEnd::finished, "the bench's campaign ends");
  run.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  run.finished_s = unix_time();
  run.processor_s = processor_seconds() - before;
  run.resident_b = resident_bytes();
  workers.stop(std::chrono::seconds(2));
  return run;
}

void AckedTrials(benchmark::State& bench) {
  const BlockedSignals blocked;
  double processor = 0.0, wall = 0.0, trials = 0.0;
  for (auto _ : bench) {
    const Folder folder;
    const CampaignRun run = run_campaign(folder.file("bench.db"), test_trials(bench.range(0)),
                                         static_cast<unsigned>(bench.range(1)));
    bench.SetIterationTime(run.wall_s);
    wall += run.wall_s;
    processor += run.processor_s;
    trials += static_cast<double>(bench.range(0));
  }
  bench.counters["acked_per_s"] = trials / wall;
  bench.counters["coordinator_us_per_trial"] = 1e6 * processor / trials;
}
BENCHMARK(AckedTrials)
    ->Args({100'000, 1})
    ->Args({100'000, 2})
    ->UseManualTime()
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

// The test study's steps take about 2.5 ns; mean_trial_ms says what came of it.
void TenMillisecondTrials(benchmark::State& bench) {
  const BlockedSignals blocked;
  constexpr unsigned kWorkers = 2;
  for (auto _ : bench) {
    const Folder folder;
    const std::string path = folder.file("bench.db");
    const CampaignRun run = run_campaign(path, test_trials(1000, 4'000'000), kWorkers);
    bench.SetIterationTime(run.wall_s);
    SQLite::Database db(path);
    SQLite::Statement sums(
        db, "SELECT sum(duration_ns) / 1e9, min(started_us) / 1e6, avg(duration_ns) / 1e6 FROM trial");
    FATMC_CHECK(sums.executeStep(), "a sum is a row");
    const double wall = run.finished_s - sums.getColumn(1).getDouble();
    bench.counters["efficiency_10ms"] = sums.getColumn(0).getDouble() / (kWorkers * wall);
    bench.counters["mean_trial_ms"] = sums.getColumn(2).getDouble();
  }
}
BENCHMARK(TenMillisecondTrials)->UseManualTime()->Iterations(1)->Unit(benchmark::kMillisecond);

/// A million trials with three scalars each, made once.
const std::string& million_trials() {
  static const Folder folder;
  static const std::string path = [] {
    const CampaignSpec spec = test_trials(kMillion);
    auto store = CampaignStore::open(folder.file("million.db"), spec, build_hash());
    FATMC_CHECK(store.has_value(), "the bench's database can be made");
    constexpr std::uint64_t kAtATime = 20'000;
    for (std::uint64_t first = 0; first < kMillion; first += kAtATime) {
      StoreRequest request{"", 0, "host", 1, {}, std::vector<std::uint32_t>(kAtATime, 1)};
      for (std::uint64_t i = first; i < first + kAtATime; ++i) {
        ComputedRow row;
        row.row.key = {0, i};
        const auto x = static_cast<double>(i);
        row.row.metrics = {{"x", x}, {"square", x * x}, {"inverse", 1.0 / (1.0 + x)}};
        row.hash = content_hash(row.row);
        request.rows.push_back(std::move(row));
      }
      store->commit(std::vector{std::move(request)});
    }
    return folder.file("million.db");
  }();
  return path;
}

void ResumeMillion(benchmark::State& bench) {
  const std::string& path = million_trials();
  const CampaignSpec spec = test_trials(kMillion + 1);
  for (auto _ : bench) {
    const auto begin = std::chrono::steady_clock::now();
    auto store = CampaignStore::open(path, spec, build_hash());
    FATMC_CHECK(store.has_value(), "the bench's database can be resumed");
    const CampaignState state(store->plan(spec), Welcome{spec.identity(), spec.tree, 0}, build_hash());
    FATMC_CHECK(state.planned() - state.stored() == 1, "one trial is left");
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    bench.SetIterationTime(elapsed);
    bench.counters["resume_million_s"] = elapsed;
  }
}
BENCHMARK(ResumeMillion)->UseManualTime()->Iterations(1)->Unit(benchmark::kMillisecond);

void AggregateMillion(benchmark::State& bench) {
  const std::string& path = million_trials();
  for (auto _ : bench) {
    const auto begin = std::chrono::steady_clock::now();
    const auto reader = CampaignReader::open(path);
    FATMC_CHECK(reader.has_value(), "the bench's database can be read");
    FATMC_CHECK(reader->outcomes().at(0).trials == kMillion, "all trials are ok");
    FATMC_CHECK(reader->database().execAndGet("SELECT mean FROM scalars WHERE name = 'x'").getDouble() ==
                    (kMillion - 1) / 2.0,
                "the mean of 0 ... n - 1");
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    bench.SetIterationTime(elapsed);
    bench.counters["aggregate_million_s"] = elapsed;
  }
}
BENCHMARK(AggregateMillion)->UseManualTime()->Iterations(1)->Unit(benchmark::kMillisecond);

void MemoryOfAMillion(benchmark::State& bench) {
  const BlockedSignals blocked;
  for (auto _ : bench) {
    const Folder folder;
    const CampaignRun small = run_campaign(folder.file("small.db"), test_trials(kMillion / 10), 2);
    const CampaignRun large = run_campaign(folder.file("large.db"), test_trials(kMillion), 2);
    bench.SetIterationTime(large.wall_s);
    bench.counters["coordinator_growth_b_per_trial"] =
        std::max(0.0, large.resident_b - small.resident_b) / (0.9 * static_cast<double>(kMillion));
    bench.counters["coordinator_mb"] = large.resident_b / 1e6;
    bench.counters["million_acked_per_s"] = static_cast<double>(kMillion) / large.wall_s;
  }
}
BENCHMARK(MemoryOfAMillion)->UseManualTime()->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fatmc

BENCHMARK_MAIN();
