// Key files: made by `fatmc keygen DIR`, read by `--keys DIR` (docs/security.md).
//
//   coordinator.key   secret of the coordinator; stays where the coordinator runs
//   coordinator.pub   its public key; workers need it
//   worker.key        secret of the workers
//   workers.pub       public keys that the coordinator admits, one a line, # begins a comment
//
// A folder with all four serves both; copy worker.key and coordinator.pub alone to other machines.
#pragma once

#include <string>

#include "core/base/error.h"
#include "proto/curve_keys.h"

namespace fatmc {

/// Makes the folder (mode 0700) where there is none and writes all four files, mode 0600. Fails when one of
/// them is there already; then nothing is written.
Status write_key_files(const std::string& folder);

/// Fails on a file that is missing or malformed, belongs to another user, or may be read (secrets) or written
/// (all) by others.
Result<CoordinatorKeys> read_coordinator_keys(const std::string& folder);
Result<WorkerKeys> read_worker_keys(const std::string& folder);

}  // namespace fatmc
