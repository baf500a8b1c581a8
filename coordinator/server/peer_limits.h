// How much one peer may send: a bucket of messages and one of bytes that refill with time.
//
// A worker stays far below: it sends a few hundred messages a second at most. Whoever sends more is broken or
// hostile; its messages are dropped unread, and since every message of the protocol is a state that is
// repeated, dropping costs an honest worker time and never a result.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

#include "coordinator/state/campaign_state.h"

namespace fatmc {

struct RateLimits {
  double messages_per_s = 10'000.0, message_burst = 10'000.0;
  double bytes_per_s = 256e6, byte_burst = 512e6;
};

class PeerLimits {
 public:
  explicit PeerLimits(const RateLimits& limits = {}) : limits_(limits) {}
  /// Whether a message of this size may be read.
  bool admit(const std::string& peer, std::size_t bytes, MonotonicTime now);
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }
  /// Forgets peers that were silent long enough for their buckets to be full.
  void forget_silent(MonotonicTime now);
  [[nodiscard]] std::size_t peers() const { return buckets_.size(); }

 private:
  struct Bucket {
    double messages, bytes;
    MonotonicTime filled;
    bool told;
  };
  RateLimits limits_;
  std::map<std::string, Bucket> buckets_;
  std::uint64_t dropped_ = 0;
};

}  // namespace fatmc
