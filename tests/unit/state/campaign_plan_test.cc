// The plan while it runs: more and fewer repetitions, priorities, pause, and the view of leases.
#include <gtest/gtest.h>

#include "coordinator/state/campaign_state.h"

namespace fatmc {
namespace {

using std::chrono::milliseconds;

const WorkerId kOne = "11111111111111111111111111111111";
const WorkerId kTwo = "22222222222222222222222222222222";

class Recorder final : public Outbox {
 public:
  void send(const WorkerId& worker, const Message& message) override {
    if (const auto* lease = std::get_if<Lease>(&message)) leases.emplace_back(worker, *lease);
    if (const auto* ack = std::get_if<Ack>(&message)) acks.push_back(ack->sequence);
  }
  void store(StoreRequest request) override { requests.push_back(std::move(request)); }
  void note(const std::string&) override {}
  std::vector<std::pair<WorkerId, Lease>> leases;
  std::vector<std::uint64_t> acks;
  std::vector<StoreRequest> requests;
};

class CampaignPlanTest : public testing::Test {
 protected:
  void make(std::vector<PlanCell> cells) {
    state_ = std::make_unique<CampaignState>(std::move(cells), Welcome{"campaign", Tree{}, 0}, "build");
    state_->on_message(kOne, Hello{kProtocolVersion, "build", kOne, "host", 7, 1}, now_, out_);
  }
  void ask(const WorkerId& worker = kOne) {
    const std::uint64_t newest = out_.leases.empty() ? 0 : out_.leases.back().second.lease;
    state_->on_message(worker, Credit{1, 0, newest}, now_, out_);
  }
  void deliver(std::uint32_t cell, std::uint64_t repetition) {
    ComputedRow row;
    row.row.key = {cell, repetition};
    row.duration_ns = 100'000'000;
    state_->on_message(kOne, Results{"campaign", ++sequence_, {row}}, now_, out_);
  }
  void commit() {
    std::vector<StoreRequest> requests;
    requests.swap(out_.requests);
    for (const StoreRequest& request : requests) {
      StoreReport report{request.worker, request.sequence, {}};
      for (const ComputedRow& row : request.rows) report.rows.emplace_back(row.row.key, StoreOutcome::stored);
      state_->on_stored(report, now_, out_);
    }
  }

  MonotonicTime now_{0};
  Recorder out_;
  std::unique_ptr<CampaignState> state_;
  std::uint64_t sequence_ = 0;
};

TEST_F(CampaignPlanTest, ACellThatGrowsIsLeasedToAWorkerThatWaits) {
  make({{.repetitions = 1}});
  ask();
  deliver(0, 0);
  commit();
  EXPECT_TRUE(state_->finished());
  ask();
  EXPECT_EQ(out_.leases.size(), 1U);
  state_->set_repetitions(0, 3, now_, out_);
  EXPECT_FALSE(state_->finished());
  EXPECT_EQ(state_->planned(), 3U);
  ASSERT_EQ(out_.leases.size(), 2U);
  EXPECT_EQ(out_.leases[1].second.first, 1U);
}

TEST_F(CampaignPlanTest, ACellThatShrinksIsFinishedAndItsLateRowsAreAcknowledgedAndDropped) {
  make({{.repetitions = 10}});
  ask();
  deliver(0, 0);
  commit();
  ask();  // leases repetition 1
  state_->set_repetitions(0, 1, now_, out_);
  EXPECT_TRUE(state_->finished());
  EXPECT_TRUE(state_->all_received());
  EXPECT_TRUE(state_->leases(now_, milliseconds(0)).empty());
  deliver(0, 1);
  EXPECT_TRUE(out_.requests.empty());
  EXPECT_EQ(out_.acks.back(), sequence_);
  EXPECT_EQ(state_->counters().out_of_plan, 1U);
}

TEST_F(CampaignPlanTest, ACellThatShrinksForgetsRowsThatWereReceivedButNotYetCommitted) {
  make({{.repetitions = 10}});
  ask();
  deliver(0, 0);
  deliver(0, 5);
  state_->set_repetitions(0, 3, now_, out_);
  commit();
  EXPECT_EQ(state_->stored(), 1U);
  EXPECT_FALSE(state_->all_received());
  for (const std::uint64_t repetition : {1, 2}) deliver(0, repetition);
  EXPECT_TRUE(state_->all_received());
  commit();
  EXPECT_TRUE(state_->finished());
}

TEST_F(CampaignPlanTest, ShrinkingAndGrowingAgainAsksForWhatWasCutOff) {
  IndexRanges stored;
  stored.insert(0, 4);
  make({{.repetitions = 10, .stored = stored}});
  state_->set_repetitions(0, 2, now_, out_);
  EXPECT_TRUE(state_->finished());
  state_->set_repetitions(0, 4, now_, out_);
  EXPECT_EQ(state_->stored(), 2U);
  ask();
  ASSERT_EQ(out_.leases.size(), 1U);
  EXPECT_EQ(out_.leases[0].second.first, 2U);
}

TEST_F(CampaignPlanTest, WhatAnotherShardComputesIsNoPartOfThePlanThatChanges) {
  IndexRanges elsewhere;
  elsewhere.insert(5, 10);
  make({{.repetitions = 10, .elsewhere = elsewhere}});
  EXPECT_EQ(state_->planned(), 5U);
  state_->set_repetitions(0, 7, now_, out_);
  EXPECT_EQ(state_->planned(), 5U);
  state_->set_repetitions(0, 3, now_, out_);
  EXPECT_EQ(state_->planned(), 3U);
}

TEST_F(CampaignPlanTest, CellsOfHigherPriorityGoFirstAndEqualOnesInTheirOrder) {
  make({{.repetitions = 1},
        {.repetitions = 1, .priority = 5},
        {.repetitions = 1},
        {.repetitions = 1, .priority = -1}});
  std::vector<std::uint32_t> order;
  for (int i = 0; i < 4; ++i) {
    ask();
    order.push_back(out_.leases.back().second.cell);
    deliver(order.back(), 0);
  }
  EXPECT_EQ(order, (std::vector<std::uint32_t>{1, 0, 2, 3}));
}

TEST_F(CampaignPlanTest, WhilePausedNothingIsLeasedAndWhatIsOutIsStored) {
  make({{.repetitions = 3}});
  ask();
  state_->pause();
  deliver(0, 0);
  commit();
  EXPECT_EQ(state_->stored(), 1U);
  ask();
  state_->on_tick(now_, out_);
  EXPECT_EQ(out_.leases.size(), 1U);
  state_->resume(now_, out_);
  EXPECT_EQ(out_.leases.size(), 2U);
}

TEST_F(CampaignPlanTest, LeasesThatAreOutForLongSayWhereAndHowOftenTheirTrialsWereTried) {
  make({{.repetitions = 1}});
  ask();
  EXPECT_TRUE(state_->leases(now_, milliseconds(1000)).empty());
  now_ += milliseconds(1500);
  auto leases = state_->leases(now_, milliseconds(1000));
  ASSERT_EQ(leases.size(), 1U);
  EXPECT_EQ(leases[0].host, "host");
  EXPECT_EQ(leases[0].pid, 7U);
  EXPECT_EQ(leases[0].missing, 1U);
  EXPECT_EQ(leases[0].attempts, 1U);
  state_->on_gone(kOne, {}, now_, out_);
  state_->on_message(kTwo, Hello{kProtocolVersion, "build", kTwo, "other", 8, 1}, now_, out_);
  state_->on_message(kTwo, Credit{1, 0, 0}, now_, out_);
  leases = state_->leases(now_, milliseconds(0));
  ASSERT_EQ(leases.size(), 1U);
  EXPECT_EQ(leases[0].host, "other");
  EXPECT_EQ(leases[0].attempts, 2U);
}

}  // namespace
}  // namespace fatmc
