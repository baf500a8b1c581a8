#include "coordinator/server/peer_limits.h"

#include <spdlog/spdlog.h>

#include <algorithm>

namespace fatmc {

bool PeerLimits::admit(const std::string& peer, std::size_t bytes, MonotonicTime now) {
  const auto [entry, is_new] =
      buckets_.try_emplace(peer, Bucket{limits_.message_burst, limits_.byte_burst, now, false});
  Bucket& bucket = entry->second;
  const double seconds = std::chrono::duration<double>(now - bucket.filled).count();
  bucket.filled = now;
  bucket.messages = std::min(limits_.message_burst, bucket.messages + seconds * limits_.messages_per_s);
  bucket.bytes = std::min(limits_.byte_burst, bucket.bytes + seconds * limits_.bytes_per_s);
  const auto size = static_cast<double>(bytes);
  if (bucket.messages < 1.0 || bucket.bytes < size) {
    ++dropped_;
    if (!bucket.told) spdlog::warn("peer {} sends too much, messages of it are dropped", peer.substr(0, 8));
    bucket.told = true;
    return false;
  }
  bucket.messages -= 1.0;
  bucket.bytes -= size;
  return true;
}

void PeerLimits::forget_silent(MonotonicTime now) {
  const double full_after =
      std::max(limits_.message_burst / limits_.messages_per_s, limits_.byte_burst / limits_.bytes_per_s);
  std::erase_if(buckets_, [&](const auto& entry) {
    return std::chrono::duration<double>(now - entry.second.filled).count() > full_after;
  });
}

}  // namespace fatmc
