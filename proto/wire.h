// The messages of docs/protocol.md as C++ types, and their frames.
//
// decode() takes whatever a socket gave: a frame that is malformed, too large, nested too deep or out of
// bounds is an Error, never an exception or a crash. What needs the plan (does this cell exist?) is checked
// by the receiver (coordinator/state).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "campaigns/base/tree.h"
#include "campaigns/base/trial_row.h"
#include "core/base/error.h"

namespace fatmc {

inline constexpr std::uint32_t kProtocolVersion = 1;
/// Largest frame, both ways; sockets are told so (ZMQ_MAXMSGSIZE).
inline constexpr std::size_t kMaxFrameBytes = std::size_t{64} << 20;
/// Most rows of one RESULTS: also the most of one transaction.
inline constexpr std::size_t kMaxRowsPerMessage = 100;
/// Rows of one RESULTS together stay below this, unless a single row is larger.
inline constexpr std::size_t kResultsTargetBytes = std::size_t{4} << 20;

struct Hello {
  std::uint32_t protocol = kProtocolVersion;
  std::string build;
  std::string incarnation;  ///< 32 hexadecimal digits, new with each start of a worker; also its routing id
  std::string host;
  std::uint32_t pid = 0;
  std::uint32_t jobs = 1;  ///< trials at a time, 1 ... 4096
  bool operator==(const Hello&) const = default;
};

struct Welcome {
  std::string campaign;
  Tree spec;  ///< decode_campaign() reads it
  std::uint32_t heartbeat_ms = 500;
  bool operator==(const Welcome&) const = default;
};

/// What a worker holds at this moment. A state and no increment, so that losing or repeating it is harmless.
struct Credit {
  std::uint32_t idle = 0;          ///< compute threads without work
  std::uint64_t queued = 0;        ///< trials leased and not begun
  std::uint64_t newest_lease = 0;  ///< the last LEASE that arrived
  bool operator==(const Credit&) const = default;
};

/// Repetitions [first, last) of one cell.
struct Lease {
  std::uint64_t lease = 0;
  std::uint32_t cell = 0;
  std::uint64_t first = 0;
  std::uint64_t last = 0;
  bool operator==(const Lease&) const = default;
};

/// A row, its hash, and what is no part of the result: when it began and how long it took.
struct ComputedRow {
  TrialRow row;
  Sha256 hash{};
  std::uint64_t started_us = 0;   ///< Unix time
  std::uint64_t duration_ns = 0;  ///< of the trial alone
  bool operator==(const ComputedRow&) const = default;
};

struct Results {
  std::string campaign;
  std::uint64_t sequence = 0;
  std::vector<ComputedRow> rows;
  bool operator==(const Results&) const = default;
};

struct Ack {
  std::uint64_t sequence = 0;
  bool operator==(const Ack&) const = default;
};

struct Heartbeat {
  Credit credit;
  std::vector<std::uint64_t> leases;
  bool operator==(const Heartbeat&) const = default;
};

struct Bye {
  std::string reason;
  bool finished = false;  ///< nothing is left to do; else the coordinator may come back
  bool operator==(const Bye&) const = default;
};

struct Refused {
  enum class Code { unspecified, protocol, build, hello_wanted, unusable_spec, trial_threw };
  Code code = Code::unspecified;
  std::string reason;
  bool operator==(const Refused&) const = default;
};

using Message = std::variant<Hello, Welcome, Credit, Lease, Results, Ack, Heartbeat, Bye, Refused>;

/// "HELLO", "WELCOME" ..., for logs.
std::string_view message_name(const Message& message);

std::string encode(const Message& message);

Result<Message> decode(std::string_view frame);

}  // namespace fatmc
