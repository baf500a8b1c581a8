#include "tests/simulation/simulated_worker.h"

#include <utility>

namespace fatmc::simulation {

SimulatedWorker::SimulatedWorker(std::string incarnation, int steps_a_trial, Time now,
                                 std::function<void(const std::string&, const std::string&)> outgoing)
    : incarnation_(std::move(incarnation)), steps_a_trial_(steps_a_trial), outgoing_(std::move(outgoing)) {
  WorkerPort& port = *this;  // make_unique could not see the private base
  session_ = std::make_unique<WorkerSession>(Hello{kProtocolVersion, "build", incarnation_, "host", 1, 1},
                                             std::nullopt, port, now);
}

void SimulatedWorker::begin(const std::shared_ptr<LoadedCampaign>& campaign, const Lease& lease) {
  for (std::uint64_t i = lease.first; i < lease.last; ++i)
    queue_.push_back({campaign, lease.lease, {lease.cell, i}});
}

void SimulatedWorker::drop_queue() {
  const std::size_t running = steps_left_ > 0 ? 1 : 0;
  while (queue_.size() > running) queue_.pop_back();
}

void SimulatedWorker::receive(const std::string& frame, Time now) {
  if (const Result<Message> message = decode(frame)) session_->on_message(*message, now);
}

bool SimulatedWorker::step(Time now, const std::function<bool(TrialKey)>& is_deadly) {
  RunnerNews news;
  if (steps_left_ == 0 && !queue_.empty()) steps_left_ = steps_a_trial_;
  if (steps_left_ > 0 && --steps_left_ == 0) {
    const Work work = queue_.front();
    queue_.pop_front();
    if (is_deadly(work.key)) return false;
    ComputedRow row = *work.campaign->run(work.key);
    row.duration_ns = static_cast<std::uint64_t>(steps_a_trial_) * 50'000'000;  // no real clock in a schedule
    row.started_us = 0;
    news.rows.push_back({work.lease, work.campaign->id(), std::move(row)});
  }
  const std::size_t running = steps_left_ > 0 ? 1 : 0;
  news.queued = queue_.size() - running;
  news.idle = queue_.empty() ? 1 : 0;
  session_->on_news(std::move(news), now);
  session_->on_tick(now);
  return true;
}

}  // namespace fatmc::simulation
