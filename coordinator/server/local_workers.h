// Worker processes on this machine, started and watched by `fatmc run`.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "proto/curve_keys.h"

namespace fatmc {

struct LocalWorkerOptions {
  std::string program;  ///< path of fatmc-worker
  std::string endpoint;
  /// Keys of the run; they reach a worker through a descriptor that it inherits. None: a plain socket.
  std::optional<WorkerKeys> keys;
  unsigned count = 1;
  bool verbose = false;
  /// Crashes without a single trial done in between after which restarting is given up: ten trials in a row
  /// that each kill three workers.
  unsigned crashes_in_vain = 30;
};

struct EndedProcess {
  std::uint32_t pid = 0;
  std::string how;  ///< it died; empty when it left in peace
};

/// Single-threaded: all calls from the server's thread.
class LocalWorkers {
 public:
  explicit LocalWorkers(LocalWorkerOptions options);
  /// Waits for them (see stop()).
  ~LocalWorkers();
  LocalWorkers(const LocalWorkers&) = delete;
  LocalWorkers& operator=(const LocalWorkers&) = delete;

  /// Throws std::system_error when a process cannot be started.
  void start();
  /// Collects processes that ended and replaces those that crashed. Returns those that ended.
  /// `done`: trials done so far, from which it sees whether restarting gets anywhere.
  std::vector<EndedProcess> reap(std::uint64_t done);
  /// Why no worker can be had any more; empty while they can.
  [[nodiscard]] const std::string& failure() const { return failure_; }
  /// Waits for all to end by themselves (they were told BYE), and ends those that do not within `patience`.
  void stop(std::chrono::milliseconds patience);

  [[nodiscard]] const std::vector<pid_t>& processes() const { return processes_; }
  [[nodiscard]] std::uint64_t restarts() const { return restarts_; }

 private:
  void spawn();
  void judge(int status, std::uint64_t done);

  LocalWorkerOptions options_;
  int keys_ = -1;
  std::vector<pid_t> processes_;
  std::uint64_t done_at_last_crash_ = 0;
  unsigned crashes_ = 0;
  std::uint64_t restarts_ = 0;
  std::string failure_;
};

/// fatmc-worker beside the program that runs; an Error when there is none that may be run.
Result<std::string> worker_program_beside_this();

}  // namespace fatmc
