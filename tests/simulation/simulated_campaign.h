// A campaign with three workers under one random schedule of faults, and the checks of its history.
//
// Faults, while the trouble lasts: messages lost, repeated, delayed and overtaking each other; workers that
// are killed, stopped and continued, slow, cut off from the network; trials that kill their worker; a
// coordinator that is killed at any moment, between a commit and its ACK included; commits that fail (disk
// full, I/O error); power cuts, which lose what was written and not synced.
//
// Checks: an ACK is sent for rows that are on disk and for no other; no trial has two rows; once the trouble
// is over the campaign ends; its digest is that of a run without faults.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "coordinator/server/group_commit.h"
#include "coordinator/state/campaign_state.h"
#include "tests/simulation/simulated_worker.h"

namespace fatmc::simulation {

struct History {
  std::vector<std::string> violations;  ///< empty: all held
  std::uint64_t trials = 0, steps = 0;
  std::uint64_t worker_deaths = 0, coordinator_deaths = 0, failed_commits = 0, power_cuts = 0,
                messages_lost = 0, copies = 0, duplicates = 0, quarantined = 0;
};

class SimulatedCampaign final : private Outbox {
 public:
  explicit SimulatedCampaign(std::uint64_t seed);
  History run();

 private:
  struct Letter {
    MonotonicTime due;
    std::string worker, frame;
  };
  struct WorkerSlot {
    std::unique_ptr<SimulatedWorker> process;
    MonotonicTime stopped_until{}, cut_off_until{}, starts_at{};
  };

  // Outbox of the coordinator
  void send(const WorkerId& worker, const Message& message) override;
  void store(StoreRequest request) override { commits_->add(std::move(request), now_); }

  [[nodiscard]] bool trouble() const;
  bool chance(double probability);
  MonotonicTime within(int milliseconds);
  void post(std::vector<Letter>& box, const WorkerId& worker, const std::string& frame);
  bool is_cut_off(const WorkerId& worker) const;
  void start_coordinator();
  void start_worker(WorkerSlot& slot);
  void strike();
  void deliver();
  void step_workers();
  void coordinate();
  void commit();
  std::vector<StoreReport> write(std::span<const StoreRequest> batch);
  bool is_deadly(TrialKey trial) const { return deadly_ && *deadly_ == trial; }
  void check_end();

  std::mt19937_64 random_;
  MonotonicTime now_{0};
  std::uint64_t ids_ = 0, first_lease_ = 1;
  std::optional<TrialKey> deadly_;
  bool calm_;  // no fault but those of coordinator and disk, and deadly trials
  double loss_, worker_death_, coordinator_death_, commit_failure_;
  CampaignSpec spec_;
  std::vector<WorkerSlot> workers_;
  std::optional<CampaignState> state_;
  std::optional<GroupCommit> commits_;
  bool coordinator_is_dead_ = false;
  MonotonicTime coordinator_starts_at_{}, disk_full_until_{};
  std::vector<Letter> to_coordinator_, to_workers_;
  std::map<TrialKey, ComputedRow> disk_;  // what is synced
  std::map<std::pair<WorkerId, std::uint64_t>, std::vector<TrialKey>> sent_;
  History history_;
};

}  // namespace fatmc::simulation
