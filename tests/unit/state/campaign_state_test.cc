// Decisions of the coordinator one at a time, under a clock of the test's own.
#include "coordinator/state/campaign_state.h"

#include <gtest/gtest.h>

namespace fatmc {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

const WorkerId kOne = "11111111111111111111111111111111";
const WorkerId kTwo = "22222222222222222222222222222222";

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

TEST_F(CampaignStateTest, AnotherBuildIsRefusedAtHello) {
  CampaignState state = make(10);
  Hello other = hello(kOne);
  other.build = "another";
  state.on_message(kOne, other, now_, out_);
  ASSERT_EQ(out_.all<Refused>(kOne).size(), 1U);
  EXPECT_EQ(out_.all<Refused>(kOne)[0].code, Refused::Code::build);
  EXPECT_TRUE(out_.all<Welcome>(kOne).empty());
  EXPECT_TRUE(state.workers().empty());
}

TEST_F(CampaignStateTest, AnotherProtocolIsRefusedAtHello) {
  CampaignState state = make(10);
  Hello other = hello(kOne);
  other.protocol = kProtocolVersion + 1;
  state.on_message(kOne, other, now_, out_);
  EXPECT_EQ(out_.all<Refused>(kOne).at(0).code, Refused::Code::protocol);
}

TEST_F(CampaignStateTest, AWorkerWithoutHelloIsAskedForOneAndItsRowsAreNotAcknowledged) {
  CampaignState state = make(10);
  deliver(state, kOne, 1, {0});
  EXPECT_EQ(out_.all<Refused>(kOne).at(0).code, Refused::Code::hello_wanted);
  EXPECT_TRUE(out_.all<Ack>(kOne).empty());
  EXPECT_TRUE(out_.requests.empty());
}

TEST_F(CampaignStateTest, RowsAreAcknowledgedAfterTheCommitOnly) {
  CampaignState state = make(2);
  join(state, kOne);
  deliver(state, kOne, 5, {0, 1});
  EXPECT_TRUE(state.all_received());
  EXPECT_FALSE(state.finished());
  EXPECT_TRUE(out_.all<Ack>(kOne).empty());
  commit_all(state);
  EXPECT_TRUE(state.finished());
  ASSERT_EQ(out_.all<Ack>(kOne).size(), 1U);
  EXPECT_EQ(out_.all<Ack>(kOne)[0].sequence, 5U);
}

TEST_F(CampaignStateTest, ALeaseThatIsNotMentionedIsGivenToAnother) {
  CampaignState state = make(1);
  join(state, kOne);
  state.on_message(kOne, Credit{1, 0, 0}, now_, out_);
  ASSERT_EQ(out_.all<Lease>(kOne).size(), 1U);
  now_ += seconds(1);
  join(state, kTwo);
  state.on_message(kTwo, Credit{1, 0, 0}, now_, out_);
  EXPECT_TRUE(out_.all<Lease>(kTwo).empty());
  // Two heartbeats of 500 ms later than the timeout of 2 s at most.
  while (now_ < milliseconds(3000)) {
    now_ += milliseconds(500);
    state.on_message(kTwo, Heartbeat{{1, 0, 0}, {}}, now_, out_);
    state.on_tick(now_, out_);
  }
  ASSERT_EQ(out_.all<Lease>(kTwo).size(), 1U);
  EXPECT_EQ(out_.all<Lease>(kTwo)[0].first, 0U);
}

TEST_F(CampaignStateTest, ALeaseThatHeartbeatsMentionIsKeptForHours) {
  CampaignState state = make(1);
  join(state, kOne);
  state.on_message(kOne, Credit{1, 0, 0}, now_, out_);
  const std::uint64_t lease = out_.all<Lease>(kOne).at(0).lease;
  for (int i = 0; i < 7200; ++i) {
    now_ += milliseconds(500);
    state.on_message(kOne, Heartbeat{{0, 0, lease}, {lease}}, now_, out_);
    state.on_tick(now_, out_);
  }
  EXPECT_EQ(state.counters().reclaimed, 0U);
}

TEST_F(CampaignStateTest, ALeaseThatWasLostOnTheWayIsGivenAgain) {
  CampaignState state = make(1);
  join(state, kOne);
  state.on_message(kOne, Credit{1, 0, 0}, now_, out_);
  for (int i = 0; i < 6; ++i) {  // the worker lives, but never heard of its lease
    now_ += milliseconds(500);
    state.on_message(kOne, Heartbeat{{1, 0, 0}, {}}, now_, out_);
    state.on_tick(now_, out_);
  }
  ASSERT_EQ(out_.all<Lease>(kOne).size(), 2U);
  EXPECT_NE(out_.all<Lease>(kOne)[0].lease, out_.all<Lease>(kOne)[1].lease);
}

TEST_F(CampaignStateTest, TheLeasesOfAProcessThatEndedAreFreeAtOnce) {
  CampaignState state = make(1);
  join(state, kOne);
  join(state, kTwo);
  state.on_message(kOne, Credit{1, 0, 0}, now_, out_);
  state.on_message(kTwo, Credit{1, 0, 0}, now_, out_);
  EXPECT_TRUE(out_.all<Lease>(kTwo).empty());
  state.on_gone(kOne, now_, out_);
  EXPECT_EQ(out_.all<Lease>(kTwo).size(), 1U);
}

TEST_F(CampaignStateTest, ALateResultIsAcceptedAndItsTrialNotLeasedAgain) {
  CampaignState state = make(1);
  join(state, kOne);
  state.on_message(kOne, Credit{1, 0, 0}, now_, out_);
  state.on_gone(kOne, now_, out_);
  join(state, kOne);
  deliver(state, kOne, 1, {0});
  commit_all(state);
  EXPECT_TRUE(state.finished());
  join(state, kTwo);
  state.on_message(kTwo, Credit{1, 0, 0}, now_, out_);
  EXPECT_TRUE(out_.all<Lease>(kTwo).empty());
}

TEST_F(CampaignStateTest, AResultThatDiffersFromTheStoredOneIsAnAlarmAndIsAcknowledged) {
  CampaignState state = make(2);
  join(state, kOne);
  deliver(state, kOne, 1, {0});
  commit_all(state);
  deliver(state, kOne, 2, {0});
  commit_all(state, StoreOutcome::conflict);
  EXPECT_EQ(state.counters().conflicts, 1U);
  EXPECT_EQ(state.stored(), 1U);
  EXPECT_EQ(out_.all<Ack>(kOne).size(), 2U);
}

TEST_F(CampaignStateTest, RowsOfNoTrialOfThePlanAreCountedAndDropped) {
  CampaignState state = make(2);
  join(state, kOne);
  Results results{"campaign", 1, {row(2), row(0)}};
  results.rows.push_back(row(0));
  results.rows.back().row.key.cell = 9;
  state.on_message(kOne, results, now_, out_);
  EXPECT_EQ(state.counters().out_of_plan, 2U);
  ASSERT_EQ(out_.requests.size(), 1U);
  EXPECT_EQ(out_.requests[0].rows.size(), 1U);
}

TEST_F(CampaignStateTest, RowsOfAnotherCampaignAreNeverStored) {
  CampaignState state = make(2);
  join(state, kOne);
  state.on_message(kOne, Results{"another", 4, {row(0)}}, now_, out_);
  EXPECT_TRUE(out_.requests.empty());
  EXPECT_EQ(state.counters().foreign, 1U);
  EXPECT_EQ(out_.all<Ack>(kOne).size(), 1U) << "or the worker would send them for ever";
}

TEST_F(CampaignStateTest, LeasesShrinkTowardsTheEnd) {
  CampaignState state = make(1000);
  join(state, kOne);
  join(state, kTwo);
  std::uint64_t sequence = 0, newest = 0, last_size = 0;
  std::vector<std::uint64_t> sizes;
  while (!state.finished()) {
    state.on_message(kOne, Credit{1, 0, newest}, now_, out_);
    const Lease lease = out_.all<Lease>(kOne).back();
    newest = lease.lease;
    last_size = lease.last - lease.first;
    sizes.push_back(last_size);
    for (std::uint64_t i = lease.first; i < lease.last; ++i)
      deliver(state, kOne, ++sequence, {i}, milliseconds(1));
    commit_all(state);
  }
  EXPECT_EQ(sizes.front(), 1U) << "the first tells how long a trial takes";
  EXPECT_GT(sizes[1], 50U);
  EXPECT_EQ(last_size, 1U);
  EXPECT_TRUE(std::is_sorted(sizes.rbegin(), sizes.rend() - 1));
}

TEST_F(CampaignStateTest, ALeaseOfLongTrialsIsShort) {
  CampaignState state = make(1000);
  join(state, kOne);
  state.on_message(kOne, Credit{1, 0, 0}, now_, out_);
  deliver(state, kOne, 1, {0}, seconds(10));
  state.on_message(kOne, Credit{1, 0, out_.all<Lease>(kOne).back().lease}, now_, out_);
  const Lease lease = out_.all<Lease>(kOne).back();
  EXPECT_EQ(lease.last - lease.first, 1U);
}

TEST_F(CampaignStateTest, ShortTrialsAreLeasedAheadAndLongOnesAreNot) {
  for (const milliseconds duration : {milliseconds(1), milliseconds(10'000)}) {
    out_ = {};
    CampaignState state = make(1000);
    join(state, kOne);
    state.on_message(kOne, Credit{1, 0, 0}, now_, out_);
    deliver(state, kOne, 1, {0}, duration);
    const std::uint64_t newest = out_.all<Lease>(kOne).back().lease;
    const std::size_t before = out_.all<Lease>(kOne).size();
    state.on_message(kOne, Credit{0, 0, newest}, now_, out_);  // busy with its last trial
    EXPECT_EQ(out_.all<Lease>(kOne).size() - before, duration < milliseconds(50) ? 1U : 0U);
  }
}

TEST_F(CampaignStateTest, StaleNewsOfAWorkerGivesItNoSecondLease) {
  CampaignState state = make(1000);
  join(state, kOne);
  state.on_message(kOne, Credit{1, 0, 0}, now_, out_);
  state.on_message(kOne, Heartbeat{{1, 0, 0}, {}}, now_, out_);  // sent before the lease arrived
  EXPECT_EQ(out_.all<Lease>(kOne).size(), 1U);
}

TEST_F(CampaignStateTest, WhatIsStoredIsNotLeased) {
  IndexRanges stored;
  stored.insert(0, 7);
  stored.insert(8, 20);  // beyond the plan, too
  CampaignState state({{10, stored}}, Welcome{"campaign", Tree{}, 0}, "build");
  EXPECT_EQ(state.planned(), 10U);
  EXPECT_EQ(state.stored(), 9U);
  join(state, kOne);
  state.on_message(kOne, Credit{1, 0, 0}, now_, out_);
  EXPECT_EQ(out_.all<Lease>(kOne).at(0).first, 7U);
  EXPECT_EQ(out_.all<Lease>(kOne).at(0).last, 8U);
}

}  // namespace
}  // namespace fatmc
