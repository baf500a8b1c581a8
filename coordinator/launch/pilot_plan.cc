#include "coordinator/launch/pilot_plan.h"

#include <algorithm>
#include <sstream>

namespace fatmc {
namespace {

// squeue also lists jobs for a while that have ended, or are about to.
bool is_over(std::string_view state) {
  for (const std::string_view over :
       {"COMPLETING", "COMPLETED", "CANCELLED", "FAILED", "TIMEOUT", "NODE_FAIL", "OUT_OF_MEMORY",
        "BOOT_FAIL", "DEADLINE", "PREEMPTED", "REVOKED", "SPECIAL_EXIT"}) {
    if (state == over) return true;
  }
  return false;
}

}  // namespace

std::vector<QueuedPilot> parse_queue(std::string_view text) {
  std::vector<QueuedPilot> out;
  std::istringstream lines{std::string(text)};
  std::string id, state;
  while (lines >> id >> state) {
    if (is_over(state)) continue;
    const bool pending = state == "PENDING" || state.starts_with("REQUEUE");
    out.push_back({id, pending});
  }
  return out;
}

PilotAction decide_pilots(const std::vector<QueuedPilot>& queue, const LaunchView& view, std::uint64_t most,
                          unsigned jobs) {
  const std::uint64_t useful = (view.left + jobs - 1) / jobs;
  const std::uint64_t wanted = std::min(most, useful);
  const auto pending = static_cast<std::uint64_t>(
      std::count_if(queue.begin(), queue.end(), [](const QueuedPilot& pilot) { return pilot.pending; }));
  // A worker that is connected is a running pilot, whether the queue knows it or not.
  const std::uint64_t running = std::max<std::uint64_t>(queue.size() - pending, view.workers);
  const std::uint64_t present = running + pending;
  PilotAction action;
  if (present < wanted) action.submit = wanted - present;
  std::uint64_t surplus = present > wanted ? std::min(present - wanted, pending) : 0;
  for (auto pilot = queue.rbegin(); pilot != queue.rend() && surplus > 0; ++pilot) {
    if (!pilot->pending) continue;
    action.cancel.push_back(pilot->id);
    --surplus;
  }
  return action;
}

void PilotTrust::submitted(std::uint64_t count, std::uint64_t stored) {
  if (stored > stored_) in_vain_ = 0;
  stored_ = stored;
  in_vain_ += count;
}

}  // namespace fatmc
