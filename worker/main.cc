// fatmc-worker: command line.
#include <signal.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "proto/endpoint.h"
#include "proto/key_files.h"
#include "worker/worker.h"

namespace {

fatmc::Status take_keys(const std::string& folder, int descriptor, fatmc::WorkerOptions& options) {
  if (!folder.empty() || descriptor >= 0) {
    const auto keys =
        folder.empty() ? fatmc::read_worker_keys_from(descriptor) : fatmc::read_worker_keys(folder);
    if (!keys) return fatmc::fail(keys.error());
    options.keys = *keys;
  }
  return fatmc::check_endpoint(options.endpoint, "--connect",
                               options.keys ? fatmc::Protection::curve : fatmc::Protection::plain);
}

int run(int argc, char** argv) {
  fatmc::WorkerOptions options;
  double leave_after_s = 0.0;
  CLI::App app(
      "Computes trials for a coordinator (fatmc coordinator, fatmc run).\n"
      "Example: fatmc-worker --connect tcp://node1:5555 --keys keys --jobs 4",
      "fatmc-worker");
  app.add_option("--connect", options.endpoint, "endpoint of the coordinator, tcp://HOST:PORT")->required();
  std::string keys;
  int keys_descriptor = -1;
  auto* folder =
      app.add_option("--keys", keys,
                     "folder of keys made by `fatmc keygen` (needed: worker.key, coordinator.pub); without, "
                     "plain TCP on the loopback");
  app.add_option("--keys-descriptor", keys_descriptor, "open descriptor with the keys; for `fatmc run`")
      ->check(CLI::Range(3, 1'000'000))
      ->excludes(folder);
  app.add_option("--jobs", options.jobs, "trials at a time")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  app.add_option("--leave-after", leave_after_s,
                 "end when no coordinator was heard for so many seconds (default: keep trying)")
      ->check(CLI::Range(0.1, 1e6));
  app.add_flag("--verbose", options.verbose, "log to standard error");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);
    std::fprintf(stderr, "fatmc-worker: %s (see fatmc-worker --help)\n", e.what());
    return 2;
  }
  if (leave_after_s > 0.0) {
    options.leave_after = std::chrono::milliseconds(static_cast<std::int64_t>(leave_after_s * 1000.0));
  }
  if (const fatmc::Status status = take_keys(keys, keys_descriptor, options); !status) {
    std::fprintf(stderr, "fatmc-worker: %s\n", status.error().text().c_str());
    return 2;
  }
  // Before any thread exists, so that all inherit it; run_worker reads them from a descriptor.
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  return fatmc::run_worker(options);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "fatmc-worker: %s\n", e.what());
    return 1;
  }
}
