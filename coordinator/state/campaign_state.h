// Who computes what: all decisions of the coordinator, without socket, database, thread or clock.
//
// Events come in as calls that carry the time; what is to be done goes out through an Outbox. A plan is cells
// with repetitions. Each trial of it is in one of these states:
//
//   pending -> leased to one worker -> received (in a batch not yet committed) -> stored
//
// A lease that its worker has not mentioned (in HEARTBEAT or RESULTS) for `lease_timeout` is taken back: that
// covers a dead worker as well as a LEASE that was lost on the way. Results are welcome from whoever brings
// them: the store drops a row that it has, so that lease expiry can only cost work and never a result.
//
// Idle workers at the end of a run get copies of what is still out, so that a slow or silent worker makes it
// at most one trial longer. A trial over which three workers died, one after another, gets the
// outcome "quarantined".
//
// Invariants (tests/unit/state): what was acknowledged is stored; a trial is stored once; while a worker
// lives, the run ends.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "campaigns/base/campaign_spec.h"
#include "coordinator/state/index_ranges.h"
#include "coordinator/state/suspects.h"
#include "proto/wire.h"

namespace fatmc {

using WorkerId = std::string;                    ///< the worker's incarnation, also its routing id
using MonotonicTime = std::chrono::nanoseconds;  ///< since any fixed moment

struct PlanCell {
  std::uint64_t repetitions = 0;
  IndexRanges stored = {};     ///< what the database has already
  IndexRanges elsewhere = {};  ///< what another shard computes: no part of this plan
  std::int64_t priority = 0;   ///< cells of a higher one go first; equals go in their order
};

/// A lease that is out, for those who ask where a trial is.
struct LeaseView {
  std::uint32_t cell = 0;
  std::uint64_t first = 0, last = 0;  ///< the span of its trials that have not come back, [first, last)
  std::uint64_t missing = 0;          ///< how many they are
  std::uint32_t attempts = 0;         ///< the most that any of them was leased, this lease included
  std::string host;
  std::uint32_t pid = 0;
  MonotonicTime since{};
};

struct StateOptions {
  std::chrono::milliseconds heartbeat{500};
  /// Found within two heartbeats, ticks included. Workers speak twice a heartbeat, so that two messages may
  /// be lost before work is done twice.
  std::chrono::milliseconds lease_timeout{900};
  /// Over how many dead workers a trial is quarantined.
  std::size_t deaths_to_quarantine = 3;
  /// A lease should keep a worker busy this long: many times the round trip (below 1 ms), short against a
  /// run.
  std::chrono::milliseconds target_lease{250};
  /// Trials shorter than this are leased ahead, before a thread is idle; of longer ones a round trip is
  /// nothing, and a queued trial would wait in one worker while another has none.
  std::chrono::milliseconds prefetch_below{50};
  std::uint64_t largest_lease = 4096;
  /// Lease ids count from here. A restarted coordinator should begin beyond those of the one before, so that
  /// a worker that lives on cannot confuse their leases.
  std::uint64_t first_lease = 1;
};

/// Outcome of a trial that kills its workers; the row has no results, and a real one may take its place.
inline constexpr const char* kQuarantined = "quarantined";

/// Rows on their way to the store.
struct StoreRequest {
  WorkerId worker;  ///< empty: the coordinator's own
  std::uint64_t sequence = 0;
  std::string host;
  std::uint32_t pid = 0;
  std::vector<ComputedRow> rows;
  std::vector<std::uint32_t> attempts;  ///< a number a row: how often its trial was leased
};

enum class StoreOutcome { stored, duplicate, conflict };

/// What became of a StoreRequest, after the commit.
struct StoreReport {
  WorkerId worker;
  std::uint64_t sequence = 0;
  std::vector<std::pair<TrialKey, StoreOutcome>> rows;
};

class Outbox {
 public:
  virtual ~Outbox() = default;
  virtual void send(const WorkerId& worker, const Message& message) = 0;
  /// To be answered by CampaignState::on_stored() once committed.
  virtual void store(StoreRequest request) = 0;
  /// A decision and its reason, for the log.
  virtual void note(const std::string& /*what*/) {}
};

struct StateCounters {
  std::uint64_t results = 0;         ///< trials whose result came in this run
  std::uint64_t duplicates = 0;      ///< rows that the database had
  std::uint64_t conflicts = 0;       ///< alarm: same trial, other result; never overwritten
  std::uint64_t out_of_plan = 0;     ///< rows of no cell or repetition of the plan
  std::uint64_t foreign = 0;         ///< batches of another campaign
  std::uint64_t refused_hellos = 0;  ///< another protocol or build
  std::uint64_t unexpected = 0;      ///< messages that a worker has no business sending
  std::uint64_t reclaimed = 0;       ///< leases taken back
  std::uint64_t copied = 0;          ///< leases of trials that were out already
  std::uint64_t quarantined = 0;     ///< trials given up in this run
};

class CampaignState {
 public:
  CampaignState(std::vector<PlanCell> plan, Welcome welcome, std::string build, StateOptions options = {});

  void on_message(const WorkerId& worker, Message message, MonotonicTime now, Outbox& out);
  void on_stored(const StoreReport& report, MonotonicTime now, Outbox& out);
  /// The worker's process has ended: its leases are free at once. `how` it died; empty when it left in peace.
  void on_gone(const WorkerId& worker, const std::string& how, MonotonicTime now, Outbox& out);
  /// Time passes: takes back what is overdue. To be called once a heartbeat or more often.
  void on_tick(MonotonicTime now, Outbox& out);
  /// For so long, until now, the coordinator listened to nobody: that is no silence of the workers.
  void on_absence(std::chrono::nanoseconds away, MonotonicTime now);

  /// Plans another number of repetitions of a cell. More: they are pending. Fewer: those beyond are planned
  /// no more, whatever became of them; rows of them that still come are acknowledged and dropped.
  void set_repetitions(std::uint32_t cell, std::uint64_t repetitions, MonotonicTime now, Outbox& out);
  [[nodiscard]] std::uint64_t repetitions(std::uint32_t cell) const { return cells_.at(cell).repetitions; }
  /// Takes rows out that are planned no more since they were received; what is left may be stored.
  void drop_out_of_plan(StoreRequest& request);
  /// Nothing is leased while paused; what is out may come back and is stored.
  void pause() { paused_ = true; }
  void resume(MonotonicTime now, Outbox& out);
  [[nodiscard]] bool paused() const { return paused_; }
  /// Leases that have been out for `age` or longer, oldest first.
  [[nodiscard]] std::vector<LeaseView> leases(MonotonicTime now, std::chrono::milliseconds age) const;
  /// While the store cannot write, nothing is leased: rows could not be kept.
  void hold_dispatch() { held_ = true; }
  void release_dispatch(MonotonicTime now, Outbox& out);

  [[nodiscard]] bool finished() const { return stored_ == planned_; }
  [[nodiscard]] std::uint64_t planned() const { return planned_; }
  [[nodiscard]] std::uint64_t stored() const { return stored_; }
  /// All that is missing is in a batch: no reason to wait for more before committing.
  [[nodiscard]] bool all_received() const { return stored_ + received_ == planned_; }
  [[nodiscard]] std::vector<WorkerId> workers() const;
  /// The workers of a process on this host; for launchers that see their children end.
  [[nodiscard]] std::vector<WorkerId> workers_of_pid(std::uint32_t pid, const std::string& host) const;
  [[nodiscard]] const StateCounters& counters() const { return counters_; }
  /// The last reason for which a worker or a HELLO was turned away; empty when there was none.
  [[nodiscard]] const std::string& last_refusal() const { return last_refusal_; }

 private:
  struct CellState {
    std::uint64_t repetitions = 0;
    std::int64_t priority = 0;
    IndexRanges pending, received, stored, elsewhere;
    std::map<std::uint64_t, std::uint32_t> retries;  ///< of trials that were leased more than once
    double mean_trial_ns = 0.0;
    std::uint64_t timed = 0;
  };
  struct WorkerState {
    Hello hello;
    MonotonicTime last_heard{};
    std::uint64_t newest_lease = 0;
    std::uint64_t alone = 0;  ///< a lease beside which it gets no other
    bool waiting = false;     ///< asked for work when there was none
    std::uint32_t idle = 0;
  };
  struct LeaseState {
    WorkerId worker;
    std::uint32_t cell = 0;
    IndexRanges missing;
    MonotonicTime since{};
    MonotonicTime last_mentioned{};
    std::uint64_t copy_of = 0;    ///< the lease whose trials these are, too
    MonotonicTime last_copied{};  ///< when its trials were last leased, to it or as a copy
    std::uint32_t copies = 0;
  };

  void on_hello(const WorkerId& worker, const Hello& hello, MonotonicTime now, Outbox& out);
  void on_credit(const WorkerId& worker, const Credit& credit, MonotonicTime now, Outbox& out);
  void on_results(const WorkerId& worker, Results results, MonotonicTime now, Outbox& out);
  void on_heartbeat(const WorkerId& worker, const Heartbeat& heartbeat, MonotonicTime now, Outbox& out);
  void take_row(const WorkerId& worker, const ComputedRow& row, MonotonicTime now);
  void measure(CellState& cell, std::uint64_t duration_ns);
  void reclaim(std::uint64_t lease);
  void forget(const WorkerId& worker, const std::string& how, MonotonicTime now, Outbox& out);
  [[nodiscard]] std::uint32_t next_cell() const;
  void quarantine(TrialKey trial, Outbox& out);
  bool grant(const WorkerId& worker, WorkerState& state, MonotonicTime now, Outbox& out);
  bool grant_copy(const WorkerId& worker, WorkerState& state, MonotonicTime now, Outbox& out);
  struct TrialRange {
    std::uint64_t first = 0, last = 0;
  };
  std::optional<TrialRange> next_range(const WorkerId& worker, const WorkerState& state, std::uint32_t cell);
  LeaseState& lease(const WorkerId& worker, WorkerState& state, std::uint32_t cell, TrialRange range,
                    MonotonicTime now, Outbox& out);
  [[nodiscard]] bool is_short(const CellState& cell) const;
  [[nodiscard]] bool may_copy(const LeaseState& lease, MonotonicTime now) const;
  [[nodiscard]] bool holds_a_lease(const WorkerId& worker) const;
  void serve_waiting(MonotonicTime now, Outbox& out);
  [[nodiscard]] std::uint64_t lease_size(const WorkerState& worker, const CellState& cell) const;

  std::vector<CellState> cells_;
  std::map<WorkerId, WorkerState> workers_;
  std::map<std::uint64_t, LeaseState> leases_;
  Welcome welcome_;
  std::string build_;
  StateOptions options_;
  std::uint64_t next_lease_;
  bool paused_ = false;
  Suspects suspects_;
  WorkerId draining_;  ///< a worker that gets nothing until it is free for a trial that must run alone
  bool held_ = false;
  std::uint64_t planned_ = 0, stored_ = 0, received_ = 0, pending_ = 0;
  StateCounters counters_;
  std::string last_refusal_;
};

}  // namespace fatmc
