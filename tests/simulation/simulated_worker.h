// A worker process of the simulation: the real WorkerSession and real trials, computed step by step.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "worker/worker_session.h"

namespace fatmc::simulation {

using Time = WorkerSession::Time;

class SimulatedWorker final : private WorkerPort {
 public:
  /// `steps_a_trial`: how slow it is. `outgoing` takes its frames.
  SimulatedWorker(std::string incarnation, int steps_a_trial, Time now,
                  std::function<void(const std::string& incarnation, const std::string& frame)> outgoing);

  /// One step of time; false when the trial that it works on kills it.
  bool step(Time now, const std::function<bool(TrialKey)>& is_deadly);
  void receive(const std::string& frame, Time now);
  void reconnected(Time now) { session_->on_connected(now); }
  [[nodiscard]] const std::string& incarnation() const { return incarnation_; }
  /// It left because it was told that the campaign is finished.
  [[nodiscard]] bool has_left() const { return session_->end().has_value(); }

 private:
  void send(const std::string& frame) override { outgoing_(incarnation_, frame); }
  void begin(const std::shared_ptr<LoadedCampaign>& campaign, const Lease& lease) override;
  void drop_queue() override;
  struct Work {
    std::shared_ptr<LoadedCampaign> campaign;
    std::uint64_t lease;
    TrialKey key;
  };
  std::string incarnation_;
  int steps_a_trial_, steps_left_ = 0;
  std::function<void(const std::string&, const std::string&)> outgoing_;
  std::deque<Work> queue_;  // the front runs while steps_left_ > 0
  std::unique_ptr<WorkerSession> session_;
};

}  // namespace fatmc::simulation
