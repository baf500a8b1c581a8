// A campaign's state under a clock and an outbox of the test's own.
#pragma once

#include <gtest/gtest.h>

#include "coordinator/state/campaign_state.h"

namespace fatmc {

using std::chrono::milliseconds;
using std::chrono::seconds;

inline const WorkerId kOne = "11111111111111111111111111111111";
inline const WorkerId kTwo = "22222222222222222222222222222222";

class RecordingOutbox final : public Outbox {
 public:
  void send(const WorkerId& worker, const Message& message) override { sent.emplace_back(worker, message); }
  void store(StoreRequest request) override { requests.push_back(std::move(request)); }

  template <typename T>
  std::vector<T> all(const WorkerId& worker) const {
    std::vector<T> out;
    for (const auto& [to, message] : sent) {
      if (to == worker && std::holds_alternative<T>(message)) out.push_back(std::get<T>(message));
    }
    return out;
  }
  std::vector<std::pair<WorkerId, Message>> sent;
  std::vector<StoreRequest> requests;
};

class CampaignStateTest : public testing::Test {
 protected:
  static CampaignState make(std::uint64_t repetitions) {
    return CampaignState({{repetitions, {}}}, Welcome{"campaign", Tree{}, 0}, "build");
  }
  static Hello hello(const WorkerId& worker, std::uint32_t jobs = 1) {
    return Hello{kProtocolVersion, "build", worker, "host", 7, jobs};
  }
  void join(CampaignState& state, const WorkerId& worker, std::uint32_t jobs = 1) {
    state.on_message(worker, hello(worker, jobs), now_, out_);
  }
  static ComputedRow row(std::uint64_t repetition, milliseconds duration = milliseconds(100)) {
    ComputedRow out;
    out.row.key = {0, repetition};
    out.hash = content_hash(out.row);
    out.duration_ns = static_cast<std::uint64_t>(std::chrono::nanoseconds(duration).count());
    return out;
  }
  void deliver(CampaignState& state, const WorkerId& worker, std::uint64_t sequence,
               const std::vector<std::uint64_t>& repetitions, milliseconds duration = milliseconds(100)) {
    Results results{"campaign", sequence, {}};
    for (const std::uint64_t repetition : repetitions) results.rows.push_back(row(repetition, duration));
    state.on_message(worker, results, now_, out_);
  }
  void commit_all(CampaignState& state, StoreOutcome outcome = StoreOutcome::stored) {
    std::vector<StoreRequest> requests;
    requests.swap(out_.requests);
    for (const StoreRequest& request : requests) {
      StoreReport report{request.worker, request.sequence, {}};
      for (const ComputedRow& computed : request.rows) report.rows.emplace_back(computed.row.key, outcome);
      state.on_stored(report, now_, out_);
    }
  }

  MonotonicTime now_{0};
  RecordingOutbox out_;
};

}  // namespace fatmc
