// The I/O side of a worker: one thread that owns the connection, a WorkerSession that decides, a TrialRunner
// that computes.
//
// Rows are kept until the coordinator acknowledges them, and sent again when it does not, when it comes back,
// or when another takes its place. docs/protocol.md tells the whole conversation.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "proto/curve_keys.h"

namespace fatmc {

struct WorkerOptions {
  std::string endpoint;
  /// Without keys the socket is plain, for the loopback alone.
  std::optional<WorkerKeys> keys;
  unsigned jobs = 1;
  /// Ends the worker when nothing was heard from a coordinator for so long, and when one says BYE; without,
  /// it keeps trying for ever, unless the campaign is finished.
  std::optional<std::chrono::milliseconds> leave_after;
  bool verbose = false;
};

/// Works until told to stop; the exit code of the program (0 done, 1 failed, 2 wrong use, 3 interrupted).
/// SIGINT and SIGTERM must be blocked; with `leave_after` SIGINT is left to the coordinator (Ctrl-C reaches
/// both).
int run_worker(const WorkerOptions& options);

}  // namespace fatmc
