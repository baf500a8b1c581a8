// How much work the engine itself is: a campaign of empty trials through real worker processes, sockets and a
// database with synchronous=FULL.
//
// acked_per_s: trials stored, committed and acknowledged a second of wall time.
// coordinator_us_per_trial: processor time of the coordinator's process, a trial.
#include <benchmark/benchmark.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>

#include "coordinator/server/campaign_server.h"
#include "coordinator/server/local_workers.h"
#include "coordinator/store/campaign_store.h"
#include "core/base/check.h"
#include "proto/build_hash.h"

namespace fatmc {
namespace {

CampaignSpec empty_trials(std::int64_t repetitions) {
  const auto value = [](auto content) { return Tree{std::move(content), "bench", 1}; };
  Tree campaign = value(Tree::Table{}), cell = campaign, tree = campaign;
  campaign.set("study", value(std::string("engine_test")));
  campaign.set("seed", value(std::int64_t{1}));
  cell.set("name", value(std::string("empty")));
  cell.set("repetitions", value(repetitions));
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

void AckedTrials(benchmark::State& bench) {
  const BlockedSignals blocked;
  const auto folder = std::filesystem::temp_directory_path() / ("fatmc_bench_" + std::to_string(::getpid()));
  double processor = 0.0, wall = 0.0, trials = 0.0;
  for (auto _ : bench) {
    std::filesystem::create_directories(folder);
    const CampaignSpec spec = empty_trials(bench.range(0));
    {
      auto store = CampaignStore::open((folder / "bench.db").string(), spec, build_hash());
      FATMC_CHECK(store.has_value(), "the bench's database can be made");
      CampaignState state(store->plan(spec), Welcome{spec.identity(), spec.tree, 0}, build_hash());
      Result<BoundSocket> socket = BoundSocket::bind();
      FATMC_CHECK(socket.has_value(), "the bench's port can be had");
      const std::string endpoint = socket->endpoint();
      CampaignServer server(std::move(*socket), {}, state, *store);
      LocalWorkers workers({FATMC_TEST_WORKER, endpoint, static_cast<unsigned>(bench.range(1))});
      const double before = processor_seconds();
      const auto begin = std::chrono::steady_clock::now();
      workers.start();
      ServerHooks hooks;
      hooks.failure = [&] { return workers.failure(); };
      FATMC_CHECK(server.run(hooks) == ServerEnd::finished, "the bench's campaign ends");
      const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      bench.SetIterationTime(elapsed);
      wall += elapsed;
      processor += processor_seconds() - before;
      trials += static_cast<double>(bench.range(0));
      workers.stop(std::chrono::seconds(2));
    }
    std::filesystem::remove_all(folder);
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

}  // namespace
}  // namespace fatmc

BENCHMARK_MAIN();
