// Decisions of the coordinator one at a time: who gets which trials, and when they are given again.
#include "tests/unit/state/campaign_state_fixture.h"

namespace fatmc {
namespace {

TEST_F(CampaignStateTest, WhileTheCoordinatorItselfWasAwayNoWorkerWasSilent) {
  CampaignState state = make(10);
  join(state, kOne);
  join(state, kTwo);
  now_ += seconds(5);
  state.on_message(kTwo, Heartbeat{{0, 0, 0}, {}}, now_, out_);
  state.on_absence(seconds(5) - milliseconds(100), now_);
  state.on_tick(now_, out_);
  EXPECT_EQ(state.workers().size(), 2U);
  now_ += milliseconds(901);  // but from then on: an absence excuses nobody for longer than it took
  state.on_tick(now_, out_);
  EXPECT_TRUE(state.workers().empty());
}

TEST_F(CampaignStateTest, TheTrialsOfAWorkerThatFallsSilentAreGivenToAnotherWithinTwoHeartbeats) {
  CampaignState state = make(1);
  join(state, kOne);
  join(state, kTwo);
  state.on_message(kOne, Credit{1, 0, 0}, now_, out_);
  ASSERT_EQ(out_.all<Lease>(kOne).size(), 1U);
  const MonotonicTime last_word = now_;
  while (now_ < last_word + milliseconds(1000)) {
    EXPECT_TRUE(out_.all<Lease>(kTwo).empty()) << "before a worker could be late once and lose a message";
    now_ += milliseconds(100);
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
  for (int i = 0; i < 3; ++i) {  // the worker lives, but never heard of its lease
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
  state.on_gone(kOne, {}, now_, out_);
  EXPECT_EQ(out_.all<Lease>(kTwo).size(), 1U);
}

TEST_F(CampaignStateTest, ALateResultIsAcceptedAndItsTrialNotLeasedAgain) {
  CampaignState state = make(1);
  join(state, kOne);
  state.on_message(kOne, Credit{1, 0, 0}, now_, out_);
  state.on_gone(kOne, {}, now_, out_);
  join(state, kOne);
  deliver(state, kOne, 1, {0});
  commit_all(state);
  EXPECT_TRUE(state.finished());
  join(state, kTwo);
  state.on_message(kTwo, Credit{1, 0, 0}, now_, out_);
  EXPECT_TRUE(out_.all<Lease>(kTwo).empty());
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

TEST_F(CampaignStateTest, AWorkerWhoseLeaseWasLostAndDoneByAnotherGetsMore) {
  CampaignState state = make(3);
  join(state, kOne);
  join(state, kTwo);
  state.on_message(kTwo, Credit{1, 0, 0}, now_, out_);
  deliver(state, kTwo, 1, {0}, seconds(2));
  state.on_message(kOne, Credit{1, 0, 0}, now_, out_);  // trial 1; the LEASE never arrives
  std::uint64_t two = out_.all<Lease>(kTwo).back().lease;
  state.on_message(kTwo, Credit{1, 0, two}, now_, out_);
  deliver(state, kTwo, 2, {2}, seconds(2));
  two = out_.all<Lease>(kTwo).back().lease;
  state.on_message(kTwo, Credit{1, 0, two}, now_, out_);
  ASSERT_EQ(out_.all<Lease>(kTwo).back().first, 1U) << "a copy";
  deliver(state, kTwo, 3, {1}, seconds(2));
  state.on_message(kTwo, Bye{}, now_, out_);
  state.set_repetitions(0, 4, now_, out_);
  ASSERT_EQ(out_.all<Lease>(kOne).size(), 1U);
  state.on_message(kOne, Heartbeat{{1, 0, 0}, {}}, now_, out_);
  ASSERT_EQ(out_.all<Lease>(kOne).size(), 2U) << "the only worker is never left without work";
  EXPECT_EQ(out_.all<Lease>(kOne)[1].first, 3U);
}

}  // namespace
}  // namespace fatmc
