// The plan while it runs: other numbers of repetitions, priorities, pause, and where trials are.
#include <algorithm>
#include <cstdint>

#include "coordinator/state/campaign_state.h"
#include "core/base/check.h"

namespace fatmc {

// The cell whose trials go next, or the number of cells when nothing is pending.
std::uint32_t CampaignState::next_cell() const {
  std::uint32_t best = static_cast<std::uint32_t>(cells_.size());
  for (std::uint32_t i = 0; i < cells_.size(); ++i) {
    if (cells_[i].pending.empty()) continue;
    if (best == cells_.size() || cells_[i].priority > cells_[best].priority) best = i;
  }
  return best;
}

void CampaignState::set_repetitions(std::uint32_t index, std::uint64_t repetitions, MonotonicTime now,
                                    Outbox& out) {
  FATMC_CHECK(index < cells_.size(), "the cell is beyond the plan");
  CellState& cell = cells_[index];
  if (repetitions > cell.repetitions) {
    cell.pending.insert(cell.repetitions, repetitions);
    pending_ += repetitions - cell.repetitions;
    planned_ += repetitions - cell.repetitions;
    cell.repetitions = repetitions;
    serve_waiting(now, out);
    return;
  }
  const auto cut = [&](IndexRanges& ranges, std::uint64_t& total) {
    const std::uint64_t before = ranges.size();
    ranges.erase(repetitions, UINT64_MAX);
    total -= before - ranges.size();
  };
  planned_ -= cell.repetitions - repetitions;
  std::uint64_t none = 0;
  cut(cell.elsewhere, none);
  planned_ -= none;  // what another shard computes was never planned here
  cut(cell.pending, pending_);
  cut(cell.received, received_);
  cut(cell.stored, stored_);
  cell.retries.erase(cell.retries.lower_bound(repetitions), cell.retries.end());
  for (auto& [id, lease] : leases_) {
    if (lease.cell == index) lease.missing.erase(repetitions, UINT64_MAX);
  }
  std::erase_if(leases_, [](const auto& entry) { return entry.second.missing.empty(); });
  cell.repetitions = repetitions;
}

void CampaignState::drop_out_of_plan(StoreRequest& request) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < request.rows.size(); ++i) {
    const TrialKey key = request.rows[i].row.key;
    if (key.repetition >= cells_.at(key.cell).repetitions) {
      ++counters_.out_of_plan;
      continue;
    }
    if (kept != i) {
      request.rows[kept] = std::move(request.rows[i]);
      request.attempts[kept] = request.attempts[i];
    }
    ++kept;
  }
  request.rows.resize(kept);
  request.attempts.resize(kept);
}

void CampaignState::resume(MonotonicTime now, Outbox& out) {
  paused_ = false;
  serve_waiting(now, out);
}

std::vector<LeaseView> CampaignState::leases(MonotonicTime now, std::chrono::milliseconds age) const {
  std::vector<LeaseView> views;
  for (const auto& [id, lease] : leases_) {
    if (now - lease.since < age || lease.missing.empty()) continue;
    LeaseView view;
    view.cell = lease.cell;
    view.first = lease.missing.ranges().begin()->first;
    view.last = lease.missing.ranges().rbegin()->second;
    view.missing = lease.missing.size();
    const auto& retries = cells_[lease.cell].retries;
    for (auto retry = retries.lower_bound(view.first); retry != retries.end() && retry->first < view.last;
         ++retry) {
      if (lease.missing.contains(retry->first)) view.attempts = std::max(view.attempts, retry->second);
    }
    ++view.attempts;
    if (const auto worker = workers_.find(lease.worker); worker != workers_.end()) {
      view.host = worker->second.hello.host;
      view.pid = worker->second.hello.pid;
    }
    view.since = lease.since;
    views.push_back(std::move(view));
  }
  std::stable_sort(views.begin(), views.end(),
                   [](const auto& a, const auto& b) { return a.since < b.since; });
  return views;
}

}  // namespace fatmc
