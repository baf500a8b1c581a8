#include "coordinator/state/campaign_state.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/check.h"

namespace fatmc {

CampaignState::CampaignState(std::vector<PlanCell> plan, Welcome welcome, std::string build,
                             StateOptions options)
    : welcome_(std::move(welcome)),
      build_(std::move(build)),
      options_(options),
      next_lease_(options.first_lease) {
  welcome_.heartbeat_ms = static_cast<std::uint32_t>(options_.heartbeat.count());
  for (PlanCell& cell : plan) {
    CellState state;
    state.repetitions = cell.repetitions;
    state.priority = cell.priority;
    state.stored = std::move(cell.stored);
    state.stored.erase(cell.repetitions, UINT64_MAX);  // more than the plan asks for
    state.elsewhere = std::move(cell.elsewhere);
    state.elsewhere.erase(cell.repetitions, UINT64_MAX);
    for (const auto& [first, last] : state.elsewhere.ranges()) state.stored.erase(first, last);
    state.pending.insert(0, cell.repetitions);
    for (const IndexRanges* out : {&state.stored, &state.elsewhere})
      for (const auto& [first, last] : out->ranges()) state.pending.erase(first, last);
    planned_ += cell.repetitions - state.elsewhere.size();
    stored_ += state.stored.size();
    pending_ += state.pending.size();
    cells_.push_back(std::move(state));
  }
}

void CampaignState::on_message(const WorkerId& worker, Message message, MonotonicTime now, Outbox& out) {
  if (const auto* hello = std::get_if<Hello>(&message)) return on_hello(worker, *hello, now, out);
  const auto known = workers_.find(worker);
  if (known == workers_.end()) {
    // After a restart of the coordinator, or a silence that was taken for death.
    if (!std::holds_alternative<Bye>(message) && !std::holds_alternative<Refused>(message)) {
      out.send(worker, Refused{Refused::Code::hello_wanted, "say HELLO first"});
    }
    return;
  }
  known->second.last_heard = now;
  if (const auto* credit = std::get_if<Credit>(&message)) {
    on_credit(worker, *credit, now, out);
  } else if (auto* results = std::get_if<Results>(&message)) {
    on_results(worker, std::move(*results), now, out);
  } else if (const auto* heartbeat = std::get_if<Heartbeat>(&message)) {
    on_heartbeat(worker, *heartbeat, now, out);
  } else if (const auto* refused = std::get_if<Refused>(&message)) {
    last_refusal_ = refused->reason;
    on_gone(worker, now, out);
  } else if (std::holds_alternative<Bye>(message)) {
    on_gone(worker, now, out);
  } else {
    ++counters_.unexpected;
  }
}

void CampaignState::on_hello(const WorkerId& worker, const Hello& hello, MonotonicTime now, Outbox& out) {
  const auto refuse = [&](Refused::Code code, std::string reason) {
    ++counters_.refused_hellos;
    last_refusal_ = reason;
    out.send(worker, Refused{code, std::move(reason)});
  };
  if (hello.incarnation != worker)
    return refuse(Refused::Code::protocol, "the routing id is not the incarnation");
  if (hello.protocol != kProtocolVersion) {
    return refuse(Refused::Code::protocol, "the worker speaks protocol " + std::to_string(hello.protocol) +
                                               ", the coordinator " + std::to_string(kProtocolVersion) +
                                               "; use programs of one build");
  }
  if (hello.build != build_) {
    return refuse(Refused::Code::build, "the worker's build " + hello.build.substr(0, 12) +
                                            " is not the coordinator's " + build_.substr(0, 12) +
                                            "; use programs of one build");
  }
  WorkerState& state = workers_[worker];
  state.hello = hello;
  state.last_heard = now;
  out.send(worker, welcome_);
}

void CampaignState::on_heartbeat(const WorkerId& worker, const Heartbeat& heartbeat, MonotonicTime now,
                                 Outbox& out) {
  for (const std::uint64_t id : heartbeat.leases) {
    const auto lease = leases_.find(id);
    if (lease != leases_.end() && lease->second.worker == worker) lease->second.last_mentioned = now;
  }
  out.send(worker, Heartbeat{});
  on_credit(worker, heartbeat.credit, now, out);
}

void CampaignState::on_credit(const WorkerId& worker, const Credit& credit, MonotonicTime now, Outbox& out) {
  WorkerState& state = workers_.at(worker);
  if (credit.newest_lease < state.newest_lease) return;  // a lease is on its way: the news is stale
  state.idle = std::min(credit.idle, state.hello.jobs);
  state.waiting = credit.queued == 0;
  if (state.waiting) grant(worker, state, now, out);
}

bool CampaignState::grant(const WorkerId& worker, WorkerState& state, MonotonicTime now, Outbox& out) {
  const std::uint32_t index = next_cell();
  if (paused_ || index == cells_.size()) return false;
  CellState* const cell = &cells_[index];
  const double prefetch_ns = std::chrono::duration<double, std::nano>(options_.prefetch_below).count();
  if (state.idle == 0 && !(cell->timed > 0 && cell->mean_trial_ns < prefetch_ns)) return false;
  const auto [first, last] = cell->pending.take(lease_size(state, *cell));
  pending_ -= last - first;
  const std::uint64_t id = next_lease_++;
  LeaseState& lease = leases_[id];
  lease.worker = worker;
  lease.cell = index;
  lease.missing.insert(first, last);
  lease.since = lease.last_mentioned = now;
  state.newest_lease = id;
  state.waiting = false;
  out.send(worker, Lease{id, lease.cell, first, last});
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
    if (pending_ == 0) return;
    if (state.waiting) grant(id, state, now, out);
  }
}

void CampaignState::on_results(const WorkerId& worker, Results results, MonotonicTime now, Outbox& out) {
  StoreRequest request;
  request.worker = worker;
  request.sequence = results.sequence;
  const Hello& hello = workers_.at(worker).hello;
  request.host = hello.host;
  request.pid = hello.pid;
  if (results.campaign != welcome_.campaign) {
    ++counters_.foreign;
    out.send(worker,
             Ack{results.sequence});  // of a campaign that this coordinator knows nothing of: let it go
    return;
  }
  request.rows.reserve(results.rows.size());
  for (ComputedRow& row : results.rows) {
    const TrialKey key = row.row.key;
    if (key.cell >= cells_.size() || key.repetition >= cells_[key.cell].repetitions ||
        cells_[key.cell].elsewhere.contains(key.repetition)) {
      ++counters_.out_of_plan;
      continue;
    }
    take_row(worker, row, now);
    const auto& retries = cells_[key.cell].retries;
    const auto retry = retries.find(key.repetition);
    request.attempts.push_back(retry == retries.end() ? 1U : 1U + retry->second);
    request.rows.push_back(std::move(row));
  }
  if (request.rows.empty()) {
    out.send(worker, Ack{results.sequence});
    return;
  }
  out.store(std::move(request));
}

void CampaignState::take_row(const WorkerId& worker, const ComputedRow& row, MonotonicTime now) {
  const auto [cell_index, repetition] = row.row.key;
  CellState& cell = cells_[cell_index];
  measure(cell, row.duration_ns);
  for (auto lease = leases_.begin(); lease != leases_.end();) {
    if (lease->second.cell == cell_index && lease->second.worker == worker) {
      if (lease->second.missing.contains(repetition)) lease->second.last_mentioned = now;
      lease->second.missing.erase(repetition);
    }
    lease = lease->second.missing.empty() ? leases_.erase(lease) : std::next(lease);
  }
  if (cell.stored.contains(repetition) || cell.received.contains(repetition)) return;
  if (cell.pending.contains(repetition)) {
    cell.pending.erase(repetition);
    --pending_;
  }
  cell.received.insert(repetition);
  ++received_;
}

void CampaignState::measure(CellState& cell, std::uint64_t duration_ns) {
  ++cell.timed;
  // A mean at first, later a forgetting one: machines grow slower and faster.
  const double weight = std::max(1.0 / static_cast<double>(cell.timed), 1.0 / 64.0);
  cell.mean_trial_ns += weight * (static_cast<double>(duration_ns) - cell.mean_trial_ns);
}

void CampaignState::on_stored(const StoreReport& report, MonotonicTime, Outbox& out) {
  for (const auto& [key, outcome] : report.rows) {
    FATMC_CHECK(key.cell < cells_.size(), "the store reports a row of no cell");
    CellState& cell = cells_[key.cell];
    if (outcome == StoreOutcome::duplicate) ++counters_.duplicates;
    if (outcome == StoreOutcome::conflict) ++counters_.conflicts;
    if (cell.received.contains(key.repetition)) {
      cell.received.erase(key.repetition);
      --received_;
    }
    // A cell may have been cut short between the receipt and the commit.
    if (key.repetition < cell.repetitions && !cell.stored.contains(key.repetition)) {
      cell.stored.insert(key.repetition);
      ++stored_;
    }
  }
  out.send(report.worker, Ack{report.sequence});
}

void CampaignState::reclaim(std::uint64_t id) {
  const auto lease = leases_.find(id);
  CellState& cell = cells_[lease->second.cell];
  ++counters_.reclaimed;
  for (const auto& [first, last] : lease->second.missing.ranges()) {
    for (std::uint64_t index = first; index < last; ++index) {
      if (cell.stored.contains(index) || cell.received.contains(index) || cell.pending.contains(index))
        continue;
      cell.pending.insert(index);
      ++cell.retries[index];
      ++pending_;
    }
  }
  const auto worker = workers_.find(lease->second.worker);
  if (worker != workers_.end() && worker->second.newest_lease == id) worker->second.newest_lease = 0;
  leases_.erase(lease);
}

void CampaignState::forget(const WorkerId& worker) {
  std::vector<std::uint64_t> held;
  for (const auto& [id, lease] : leases_) {
    if (lease.worker == worker) held.push_back(id);
  }
  for (const std::uint64_t id : held) reclaim(id);
  workers_.erase(worker);
}

void CampaignState::on_gone(const WorkerId& worker, MonotonicTime now, Outbox& out) {
  forget(worker);
  serve_waiting(now, out);
}

void CampaignState::on_tick(MonotonicTime now, Outbox& out) {
  std::vector<WorkerId> silent;
  for (const auto& [id, worker] : workers_) {
    if (now - worker.last_heard > options_.lease_timeout) silent.push_back(id);
  }
  for (const WorkerId& id : silent) forget(id);
  std::vector<std::uint64_t> overdue;
  for (const auto& [id, lease] : leases_) {
    if (now - lease.last_mentioned > options_.lease_timeout) overdue.push_back(id);
  }
  for (const std::uint64_t id : overdue) reclaim(id);
  serve_waiting(now, out);
}

std::vector<WorkerId> CampaignState::workers() const {
  std::vector<WorkerId> out;
  for (const auto& [id, worker] : workers_) out.push_back(id);
  return out;
}

std::vector<WorkerId> CampaignState::workers_of_pid(std::uint32_t pid, const std::string& host) const {
  std::vector<WorkerId> out;
  for (const auto& [id, worker] : workers_) {
    if (worker.hello.pid == pid && worker.hello.host == host) out.push_back(id);
  }
  return out;
}

}  // namespace fatmc
