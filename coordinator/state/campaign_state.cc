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
    on_gone(worker, refused->code == Refused::Code::trial_threw ? refused->reason : std::string(), now, out);
  } else if (std::holds_alternative<Bye>(message)) {
    on_gone(worker, {}, now, out);
  } else {
    ++counters_.unexpected;
  }
}

void CampaignState::on_hello(const WorkerId& worker, const Hello& hello, MonotonicTime now, Outbox& out) {
  const auto refuse = [&](Refused::Code code, std::string reason) {
    ++counters_.refused_hellos;
    last_refusal_ = reason;
    out.note("refused worker " + worker.substr(0, 8) + " of host " + hello.host + ": " + reason);
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
  suspects_.absolve(worker);
  // A worker that says HELLO anew has dropped what it had not begun: its leases are free.
  if (workers_.contains(worker)) forget(worker, {}, now, out);
  out.note("worker " + worker.substr(0, 8) + " joins: host " + hello.host + ", process " +
           std::to_string(hello.pid) + ", " + std::to_string(hello.jobs) + " at a time");
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
  // A lease is on its way, and the news is stale. Unless others have brought its trials meanwhile: then it may
  // have been lost, and nothing would ever make up for it.
  if (credit.newest_lease < state.newest_lease && leases_.contains(state.newest_lease)) return;
  state.idle = std::min(credit.idle, state.hello.jobs);
  state.waiting = credit.queued == 0;
  if (state.waiting) grant(worker, state, now, out);
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
  suspects_.clear(row.row.key);
  for (auto lease = leases_.begin(); lease != leases_.end();) {
    LeaseState& held = lease->second;
    if (held.cell != cell_index || !held.missing.contains(repetition)) {
      ++lease;
      continue;
    }
    if (held.worker == worker) held.last_mentioned = now;
    held.missing.erase(repetition);  // of a copy, too: it would be done in vain
    lease = held.missing.empty() ? leases_.erase(lease) : std::next(lease);
  }
  if (cell.stored.contains(repetition) || cell.received.contains(repetition)) return;
  if (cell.pending.contains(repetition)) {
    cell.pending.erase(repetition);
    --pending_;
  }
  cell.received.insert(repetition);
  ++received_;
  ++counters_.results;
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
    cell.retries.erase(key.repetition);
    if (outcome == StoreOutcome::conflict) {
      out.note("ALARM: worker " + report.worker.substr(0, 8) + " brings another result of trial " +
               std::to_string(key.repetition) + " of cell " + std::to_string(key.cell) +
               " than is stored; the stored one stays");
    }
  }
  if (!report.worker.empty()) out.send(report.worker, Ack{report.sequence});
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
