// fatmc-worker: command line.
#include <signal.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "proto/endpoint.h"
#include "worker/worker.h"

namespace {

int run(int argc, char** argv) {
  fatmc::WorkerOptions options;
  double leave_after_s = 0.0;
  CLI::App app(
      "Computes trials for a coordinator (fatmc coordinator, fatmc run).\n"
      "Example: fatmc-worker --connect tcp://127.0.0.1:5555 --jobs 4",
      "fatmc-worker");
  app.add_option("--connect", options.endpoint, "endpoint of the coordinator, tcp://HOST:PORT")->required();
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
  if (const fatmc::Status status = fatmc::check_plain_endpoint(options.endpoint, "--connect"); !status) {
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
