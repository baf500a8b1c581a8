// Decisions of the coordinator one at a time: copies of trials at the tail.
#include "tests/unit/state/campaign_state_fixture.h"

namespace fatmc {
namespace {

TEST_F(CampaignStateTest, AnIdleWorkerGetsACopyOfALongTrialThatIsOut) {
  CampaignState state = make(2);
  join(state, kOne);
  join(state, kTwo);
  state.on_message(kOne, Credit{1, 0, 0}, now_, out_);
  state.on_message(kTwo, Credit{1, 0, 0}, now_, out_);
  now_ += seconds(2);
  deliver(state, kTwo, 1, {1}, seconds(2));
  state.on_message(kTwo, Credit{1, 0, out_.all<Lease>(kTwo).back().lease}, now_, out_);
  ASSERT_EQ(out_.all<Lease>(kTwo).size(), 2U);
  EXPECT_EQ(out_.all<Lease>(kTwo)[1].first, 0U) << "the trial of the slow worker";
  now_ += seconds(2);
  deliver(state, kTwo, 2, {0}, seconds(2));
  commit_all(state);
  EXPECT_TRUE(state.finished()) << "two trials after the start, however slow the other";
  deliver(state, kOne, 1, {0}, seconds(20));
  commit_all(state, StoreOutcome::duplicate);
  EXPECT_EQ(state.counters().duplicates, 1U);
  EXPECT_EQ(out_.all<Ack>(kOne).size(), 1U) << "a late result is let go";
}

TEST_F(CampaignStateTest, ShortTrialsAreCopiedFromTheEndAndNotBeforeTheyCouldBeDone) {
  CampaignState state = make(101);
  join(state, kOne);
  join(state, kTwo);
  state.on_message(kOne, Credit{1, 0, 0}, now_, out_);
  deliver(state, kOne, 1, {0}, milliseconds(1));
  std::uint64_t newest = out_.all<Lease>(kOne).back().lease;
  do {
    state.on_message(kOne, Credit{0, 0, newest}, now_, out_);
    if (out_.all<Lease>(kOne).back().lease == newest) break;
    newest = out_.all<Lease>(kOne).back().lease;
  } while (true);
  EXPECT_EQ(out_.all<Lease>(kOne).back().last, 101U) << "one holds all that is left";
  state.on_message(kTwo, Credit{1, 0, 0}, now_, out_);
  EXPECT_TRUE(out_.all<Lease>(kTwo).empty());
  now_ += milliseconds(300);
  state.on_message(kTwo, Heartbeat{{1, 0, 0}, {}}, now_, out_);
  ASSERT_EQ(out_.all<Lease>(kTwo).size(), 1U);
}

TEST_F(CampaignStateTest, ATrialThatIsCopiedIsNotLeasedAThirdTimeWhenItsFirstWorkerDies) {
  CampaignState state = make(2);
  join(state, kOne);
  join(state, kTwo);
  state.on_message(kOne, Credit{1, 0, 0}, now_, out_);
  state.on_message(kTwo, Credit{1, 0, 0}, now_, out_);
  deliver(state, kTwo, 1, {1}, seconds(2));
  state.on_message(kTwo, Credit{1, 0, out_.all<Lease>(kTwo).back().lease}, now_, out_);
  ASSERT_EQ(out_.all<Lease>(kTwo).size(), 2U);
  state.on_gone(kOne, "signal Killed", now_, out_);
  const WorkerId three = std::string(32, '3');
  join(state, three);
  state.on_message(three, Credit{1, 0, 0}, now_, out_);
  ASSERT_TRUE(out_.all<Lease>(three).empty()) << "the copy is under way, and this one is suspected";
  deliver(state, kTwo, 2, {0}, seconds(2));
  commit_all(state);
  EXPECT_TRUE(state.finished());
}

}  // namespace
}  // namespace fatmc
