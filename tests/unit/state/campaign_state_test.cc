// Decisions of the coordinator one at a time: who is let in, which rows are taken and when they are acknowledged.
#include "tests/unit/state/campaign_state_fixture.h"

namespace fatmc {
namespace {

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

TEST_F(CampaignStateTest, NothingIsLeasedWhileTheStoreCannotWriteAndAllGoesOnWhenItCan) {
  CampaignState state = make(10);
  join(state, kOne);
  state.hold_dispatch();
  state.on_message(kOne, Credit{1, 0, 0}, now_, out_);
  state.on_message(kOne, Heartbeat{{1, 0, 0}, {}}, now_, out_);
  state.on_tick(now_, out_);
  EXPECT_TRUE(out_.all<Lease>(kOne).empty());
  state.release_dispatch(now_, out_);
  EXPECT_EQ(out_.all<Lease>(kOne).size(), 1U);
}

}  // namespace
}  // namespace fatmc
