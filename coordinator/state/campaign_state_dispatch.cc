// Which worker gets which trials: leases, copies of what is late, what is taken back, what is given up.
#include <algorithm>
#include <cmath>
#include <utility>

#include "coordinator/state/campaign_state.h"

namespace fatmc {
namespace {

using std::chrono::milliseconds;

// A copy is made at once of a trial that takes long; of many short ones after they could have been done. A
// second copy waits until the first could have been done twice, by a cell's mean or, while that is unknown,
// by this.
constexpr milliseconds kUnknownLength{1000};

std::string name_of(const WorkerId& worker) { return "worker " + worker.substr(0, 8); }

}  // namespace

bool CampaignState::is_short(const CellState& cell) const {
  return cell.timed > 0 &&
         cell.mean_trial_ns < std::chrono::duration<double, std::nano>(options_.prefetch_below).count();
}

bool CampaignState::holds_a_lease(const WorkerId& worker) const {
  return std::any_of(leases_.begin(), leases_.end(),
                     [&](const auto& l) { return l.second.worker == worker; });
}

bool CampaignState::grant(const WorkerId& worker, WorkerState& state, MonotonicTime now, Outbox& out) {
  if (held_ || paused_ || leases_.contains(state.alone)) return false;
  const std::uint32_t index = next_cell();
  if (index == cells_.size()) return grant_copy(worker, state, now, out);
  CellState& cell = cells_[index];
  if (state.idle == 0 && !is_short(cell)) return false;
  const std::optional<TrialRange> range = next_range(worker, state, index);
  if (!range) return false;
  cell.pending.erase(range->first, range->last);
  pending_ -= range->last - range->first;
  lease(worker, state, index, *range, now, out);
  return true;
}

// The first trials of the cell that this worker may have. A suspect goes alone and never ahead; before it is
// given up it has a worker to itself, so that no trial is blamed for what its neighbour did.
std::optional<CampaignState::TrialRange> CampaignState::next_range(const WorkerId& worker,
                                                                   const WorkerState& state,
                                                                   std::uint32_t cell) {
  for (const auto& [begin, last] : cells_[cell].pending.ranges()) {
    for (std::uint64_t first = begin; first < last; ++first) {
      const std::size_t deaths = suspects_.deaths({cell, first});
      if (deaths == 0) {
        const std::uint64_t end = std::min(last, suspects_.next(cell, first));
        return TrialRange{first, first + std::min(end - first, lease_size(state, cells_[cell]))};
      }
      if (state.idle == 0) return std::nullopt;
      if (deaths + 1 < options_.deaths_to_quarantine || !holds_a_lease(worker)) {
        if (draining_ == worker) draining_.clear();
        return TrialRange{first, first + 1};
      }
      if (draining_.empty()) draining_ = worker;
      if (draining_ == worker) return std::nullopt;
    }
  }
  return std::nullopt;
}

CampaignState::LeaseState& CampaignState::lease(const WorkerId& worker, WorkerState& state,
                                                std::uint32_t cell, TrialRange range, MonotonicTime now,
                                                Outbox& out) {
  const std::uint64_t id = next_lease_++;
  LeaseState& lease = leases_[id];
  lease.worker = worker;
  lease.cell = cell;
  lease.missing.insert(range.first, range.last);
  lease.since = lease.last_mentioned = lease.last_copied = now;
  state.newest_lease = id;
  state.waiting = false;
  const std::size_t deaths = suspects_.deaths({cell, range.first});
  if (deaths > 0 && (state.hello.jobs == 1 || deaths + 1 >= options_.deaths_to_quarantine)) state.alone = id;
  out.send(worker, Lease{id, cell, range.first, range.last});
  return lease;
}

bool CampaignState::may_copy(const LeaseState& lease, MonotonicTime now) const {
  const CellState& cell = cells_[lease.cell];
  const auto mean = std::chrono::nanoseconds(static_cast<std::int64_t>(std::min(cell.mean_trial_ns, 1e17)));
  MonotonicTime wait{};
  if (cell.timed == 0) {
    wait = kUnknownLength;
  } else if (lease.copies > 0) {
    wait = 2 * mean + options_.target_lease;
  } else if (is_short(cell)) {
    wait = options_.target_lease;
  }
  return lease.copy_of == 0 && now - lease.last_copied >= wait;
}

// Nothing is left to lease, but somebody may be slow: an idle worker does the trial that is out longest, too,
// and the first result counts. Of a lease of many it takes the later half, which its owner comes to last.
bool CampaignState::grant_copy(const WorkerId& worker, WorkerState& state, MonotonicTime now, Outbox& out) {
  if (state.idle == 0) return false;
  auto slowest = leases_.end();
  for (auto entry = leases_.begin(); entry != leases_.end(); ++entry) {
    const LeaseState& held = entry->second;
    if (held.worker == worker || !may_copy(held, now)) continue;
    if (suspects_.deaths({held.cell, held.missing.ranges().rbegin()->first}) > 0) continue;
    if (slowest == leases_.end() || held.last_copied < slowest->second.last_copied) slowest = entry;
  }
  if (slowest == leases_.end()) return false;
  const std::uint64_t id = slowest->first;
  LeaseState& original = slowest->second;
  const auto [first, last] = *original.missing.ranges().rbegin();
  const std::uint64_t half = (last - first + 1) / 2;
  const std::uint64_t size = std::min(half, lease_size(state, cells_[original.cell]));
  original.last_copied = now;
  ++original.copies;
  ++counters_.copied;
  out.note(name_of(worker) + " is idle and gets a copy of trials " + std::to_string(last - size) + " to " +
           std::to_string(last - 1) + " of cell " + std::to_string(original.cell) + ", out at " +
           name_of(original.worker));
  lease(worker, state, original.cell, {last - size, last}, now, out).copy_of = id;
  return true;
}

// Guided self-scheduling (Polychronopoulos and Kuck 1987, with half of the share): a worker gets half of its
// fair part of what is left, so that leases shrink towards the end, but no more than `target_lease` of work.
std::uint64_t CampaignState::lease_size(const WorkerState& worker, const CellState& cell) const {
  const std::uint64_t least = std::max<std::uint64_t>(worker.idle, 1);
  if (cell.timed == 0) return least;  // one trial a thread tells how long they take
  std::uint64_t threads = 0;
  for (const auto& [id, other] : workers_) threads += other.hello.jobs;
  const double jobs = worker.hello.jobs;
  const double guided =
      static_cast<double>(pending_) * jobs / (2.0 * static_cast<double>(std::max<std::uint64_t>(threads, 1)));
  const double target = std::chrono::duration<double, std::nano>(options_.target_lease).count() * jobs /
                        std::max(cell.mean_trial_ns, 1.0);
  const double size = std::min({guided, target, static_cast<double>(options_.largest_lease)});
  return std::max(least, static_cast<std::uint64_t>(size));
}

void CampaignState::serve_waiting(MonotonicTime now, Outbox& out) {
  for (auto& [id, state] : workers_) {
    if (state.waiting) grant(id, state, now, out);
  }
}

void CampaignState::release_dispatch(MonotonicTime now, Outbox& out) {
  held_ = false;
  serve_waiting(now, out);
}

void CampaignState::reclaim(std::uint64_t id) {
  const auto taken = leases_.extract(id);
  const LeaseState& held = taken.mapped();
  CellState& cell = cells_[held.cell];
  ++counters_.reclaimed;
  std::vector<LeaseState*> kin;  // others with the same trials
  for (auto& [other, lease] : leases_) {
    if (lease.copy_of == id || other == held.copy_of || (held.copy_of != 0 && lease.copy_of == held.copy_of))
      kin.push_back(&lease);
    if (lease.copy_of == id) lease.copy_of = 0;
  }
  for (const auto& [first, last] : held.missing.ranges()) {
    for (std::uint64_t index = first; index < last; ++index) {
      const auto has_it = [&](const LeaseState* lease) { return lease->missing.contains(index); };
      if (std::any_of(kin.begin(), kin.end(), has_it)) continue;
      ++cell.retries[index];
      cell.pending.insert(index);
      ++pending_;
    }
  }
  const auto worker = workers_.find(held.worker);
  if (worker != workers_.end() && worker->second.newest_lease == id) worker->second.newest_lease = 0;
}

void CampaignState::forget(const WorkerId& worker, const std::string& how, MonotonicTime now, Outbox& out) {
  std::vector<std::uint64_t> held;
  std::vector<TrialKey> given_up;
  for (const auto& [id, lease] : leases_) {
    if (lease.worker != worker) continue;
    held.push_back(id);
    if (how.empty()) continue;
    for (const auto& [first, last] : lease.missing.ranges()) {
      for (std::uint64_t index = first; index < last; ++index) {
        const TrialKey key{lease.cell, index};
        suspects_.blame(key, {worker, how, lease.since, now});
        if (suspects_.deaths(key) >= options_.deaths_to_quarantine) given_up.push_back(key);
      }
    }
  }
  if (!how.empty()) {
    out.note(name_of(worker) + " is dead (" + how + "), " + std::to_string(held.size()) +
             " leases are free again");
  }
  for (const std::uint64_t id : held) reclaim(id);
  workers_.erase(worker);
  if (draining_ == worker) draining_.clear();
  for (const TrialKey& key : given_up) quarantine(key, out);
}

void CampaignState::quarantine(TrialKey trial, Outbox& out) {
  CellState& cell = cells_[trial.cell];
  if (!cell.pending.contains(trial.repetition)) return;
  cell.pending.erase(trial.repetition);
  --pending_;
  cell.received.insert(trial.repetition);
  ++received_;
  ++counters_.quarantined;
  ComputedRow row;
  row.row.key = trial;
  row.row.outcome = kQuarantined;
  row.row.detail = "killed its worker " + std::to_string(suspects_.deaths(trial)) +
                   " times, at last: " + suspects_.last_death(trial);
  row.hash = content_hash(row.row);
  out.note("trial " + std::to_string(trial.repetition) + " of cell " + std::to_string(trial.cell) +
           " is quarantined: " + row.row.detail);
  StoreRequest request;
  request.host = "coordinator";
  request.attempts = {cell.retries[trial.repetition]};
  request.rows = {std::move(row)};
  suspects_.clear(trial);
  out.store(std::move(request));
}

void CampaignState::on_gone(const WorkerId& worker, const std::string& how, MonotonicTime now, Outbox& out) {
  forget(worker, how, now, out);
  serve_waiting(now, out);
}

void CampaignState::on_absence(std::chrono::nanoseconds away, MonotonicTime now) {
  for (auto& [id, worker] : workers_) worker.last_heard = std::min(worker.last_heard + away, now);
  for (auto& [id, lease] : leases_) lease.last_mentioned = std::min(lease.last_mentioned + away, now);
}

void CampaignState::on_tick(MonotonicTime now, Outbox& out) {
  std::vector<WorkerId> silent;
  for (const auto& [id, worker] : workers_) {
    if (now - worker.last_heard > options_.lease_timeout) silent.push_back(id);
  }
  const std::string how = "no word for " + std::to_string(options_.lease_timeout.count()) + " ms";
  for (const WorkerId& id : silent) forget(id, how, now, out);
  std::vector<std::uint64_t> overdue;
  for (const auto& [id, lease] : leases_) {
    if (now - lease.last_mentioned > options_.lease_timeout) overdue.push_back(id);
  }
  for (const std::uint64_t id : overdue) {
    out.note(name_of(leases_.at(id).worker) + " does not mention its lease " + std::to_string(id) +
             ", which is free again");
    reclaim(id);
  }
  serve_waiting(now, out);
}

}  // namespace fatmc
