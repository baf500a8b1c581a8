// CURVE keys: who may speak to a coordinator, and how a worker knows that it is the right one.
//
// A key pair belongs to the coordinator and one to its workers (or one to each worker). The coordinator
// admits the public keys of its list and no other; the worker encrypts for one coordinator's key, so that no
// other can answer. Curve25519 as libsodium and libzmq have it (docs/security.md).
#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>

#include "core/base/error.h"

namespace fatmc {

using CurveKey = std::array<std::uint8_t, 32>;

struct CurvePair {
  CurveKey open{};    ///< the public half
  CurveKey secret{};  ///< never in a log, a command line or an environment
};

/// What a worker needs.
struct WorkerKeys {
  CurvePair own;
  CurveKey coordinator{};
};

/// What a coordinator needs.
struct CoordinatorKeys {
  CurvePair own;
  std::set<CurveKey> admitted;  ///< workers
};

CurvePair make_curve_pair();
CurvePair pair_of_secret(const CurveKey& secret);

/// 64 hexadecimal digits, and back; the error says what is wrong without repeating the text.
std::string key_text(const CurveKey& key);
Result<CurveKey> parse_key(std::string_view text);

/// Keys of one run, for a coordinator and the workers that it starts itself.
struct RunKeys {
  CoordinatorKeys coordinator;
  WorkerKeys worker;
};
RunKeys make_run_keys();

/// How the keys reach a worker that a coordinator starts on its own machine: through a descriptor that the
/// child inherits, since every user can read arguments and, for a moment, files. An anonymous file, closed on
/// exec; throws std::system_error.
int open_worker_keys(const WorkerKeys& keys);
/// Reads them from the start of such a descriptor, which other workers may share.
Result<WorkerKeys> read_worker_keys_from(int descriptor);

}  // namespace fatmc
