// Decisions of the coordinator one at a time: trials that kill their workers.
#include "tests/unit/state/campaign_state_fixture.h"

namespace fatmc {
namespace {

class Killers : public CampaignStateTest {
 protected:
  // A new worker gets a lease and dies of it.
  Lease die(CampaignState& state, std::uint32_t jobs = 1, const std::string& how = "signal Aborted") {
    const WorkerId worker = fresh();
    join(state, worker, jobs);
    state.on_message(worker, Credit{jobs, 0, 0}, now_, out_);
    EXPECT_EQ(out_.all<Lease>(worker).size(), 1U);
    const Lease lease = out_.all<Lease>(worker).at(0);
    state.on_gone(worker, how, now_, out_);
    return lease;
  }
  WorkerId fresh() { return std::string(31, 'f') + std::string(1, static_cast<char>('0' + workers_++)); }
  int workers_ = 0;
};

TEST_F(Killers, ATrialOverWhichThreeWorkersDiedIsQuarantinedWithTheReasonAndTheRunEnds) {
  CampaignState state = make(1);
  die(state);
  die(state);
  EXPECT_TRUE(out_.requests.empty());
  die(state, 1, "signal Segmentation fault");
  ASSERT_EQ(out_.requests.size(), 1U);
  const StoreRequest& request = out_.requests[0];
  ASSERT_EQ(request.rows.size(), 1U);
  EXPECT_EQ(request.rows[0].row.outcome, kQuarantined);
  EXPECT_EQ(request.rows[0].row.detail, "killed its worker 3 times, at last: signal Segmentation fault");
  EXPECT_EQ(request.rows[0].hash, content_hash(request.rows[0].row));
  EXPECT_EQ(request.attempts[0], 3U);
  commit_all(state);
  EXPECT_TRUE(state.finished());
  EXPECT_EQ(state.counters().quarantined, 1U);
}

TEST_F(Killers, WorkersThatLeaveInPeaceAreNobodysFault) {
  CampaignState state = make(1);
  for (int i = 0; i < 6; ++i) die(state, 1, "");
  EXPECT_EQ(state.counters().quarantined, 0U);
}

TEST_F(Killers, ASuspectIsLeasedAloneAndItsNeighboursAreCleared) {
  CampaignState state = make(40);
  join(state, kOne);
  state.on_message(kOne, Credit{1, 0, 0}, now_, out_);
  deliver(state, kOne, 1, {0}, milliseconds(1));
  state.on_message(kOne, Credit{1, 0, out_.all<Lease>(kOne).back().lease}, now_, out_);
  const Lease many = out_.all<Lease>(kOne).back();
  ASSERT_GT(many.last - many.first, 5U);
  state.on_gone(kOne, "signal Killed", now_, out_);
  join(state, kTwo);
  std::uint64_t newest = 0, sequence = 0;
  for (std::uint64_t i = many.first; i < many.last; ++i) {
    state.on_message(kTwo, Credit{1, 0, newest}, now_, out_);
    const Lease one = out_.all<Lease>(kTwo).back();
    EXPECT_EQ(one.first, i);
    EXPECT_EQ(one.last, i + 1) << "a suspect goes alone";
    newest = one.lease;
    state.on_message(kTwo, Credit{0, 0, newest}, now_, out_);
    EXPECT_EQ(out_.all<Lease>(kTwo).back().lease, newest) << "and nothing is leased ahead of it";
    deliver(state, kTwo, ++sequence, {i}, milliseconds(1));
  }
  state.on_message(kTwo, Credit{1, 0, newest}, now_, out_);
  EXPECT_GT(out_.all<Lease>(kTwo).back().last - out_.all<Lease>(kTwo).back().first, 1U)
      << "the rest is innocent";
}

TEST_F(Killers, BeforeATrialIsGivenUpItHasAWorkerToItself) {
  CampaignState state = make(8);
  EXPECT_EQ(die(state, 2).last, 2U);
  EXPECT_EQ(die(state, 2).last, 1U);  // trial 0 alone; now two workers died over it, and one over trial 1
  join(state, kOne, 2);
  state.on_message(kOne, Credit{2, 0, 0}, now_, out_);
  const Lease first = out_.all<Lease>(kOne).at(0);
  ASSERT_EQ(first.first, 0U);
  ASSERT_EQ(first.last, 1U);
  state.on_message(kOne, Credit{1, 0, first.lease}, now_, out_);
  EXPECT_EQ(out_.all<Lease>(kOne).size(), 1U) << "nothing runs beside it";
  deliver(state, kOne, 1, {0});  // innocent
  state.on_gone(kOne, {}, now_, out_);
  EXPECT_EQ(die(state, 2).first, 1U);
  const Lease last = die(state, 2);
  EXPECT_EQ(last.first, 1U);
  EXPECT_EQ(last.last, 2U);
  ASSERT_EQ(out_.requests.size(), 2U);
  EXPECT_EQ(out_.requests[1].rows[0].row.key.repetition, 1U) << "the culprit alone is given up";
  EXPECT_EQ(state.counters().quarantined, 1U);
}

TEST_F(Killers, ABusyWorkerIsDrainedForATrialThatMustRunAloneAndOthersWorkOn) {
  CampaignState state = make(20);
  join(state, kOne, 2);
  join(state, kTwo, 2);
  state.on_message(kOne, Credit{2, 0, 0}, now_, out_);  // trials 0, 1
  state.on_message(kTwo, Credit{2, 0, 0}, now_, out_);  // trials 2, 3
  die(state, 1);                                        // trial 4
  die(state, 1);
  deliver(state, kOne, 1, {0}, seconds(1));
  const std::uint64_t one = out_.all<Lease>(kOne).back().lease, two = out_.all<Lease>(kTwo).back().lease;
  state.on_message(kOne, Credit{1, 0, one}, now_, out_);
  EXPECT_EQ(out_.all<Lease>(kOne).size(), 1U) << "waits for its other thread";
  deliver(state, kTwo, 1, {2}, seconds(1));
  state.on_message(kTwo, Credit{1, 0, two}, now_, out_);
  EXPECT_EQ(out_.all<Lease>(kTwo).back().first, 5U) << "passes the suspect by";
  deliver(state, kOne, 2, {1}, seconds(1));
  state.on_message(kOne, Credit{2, 0, one}, now_, out_);
  EXPECT_EQ(out_.all<Lease>(kOne).back().first, 4U);
  EXPECT_EQ(out_.all<Lease>(kOne).back().last, 5U);
}

TEST_F(Killers, SilenceIsDeathUntilTheWorkerSpeaksAgain) {
  CampaignState state = make(1);
  for (int i = 0; i < 5; ++i) {
    join(state, kOne);
    state.on_message(kOne, Credit{1, 0, 0}, now_, out_);
    now_ += seconds(3);
    state.on_tick(now_, out_);
    EXPECT_TRUE(state.workers().empty());
  }
  EXPECT_EQ(state.counters().quarantined, 0U) << "one worker that stutters, not three that died";
  const WorkerId others[] = {fresh(), fresh(), fresh()};
  for (const WorkerId& other : others) {
    join(state, other);
    state.on_message(other, Credit{1, 0, 0}, now_, out_);
    now_ += seconds(3);
    state.on_tick(now_, out_);
  }
  EXPECT_EQ(state.counters().quarantined, 1U);
}

TEST_F(Killers, WorkersThatFallSilentTogetherOverCopiesOfATrialCountAsOne) {
  CampaignState state = make(2);
  const WorkerId holders[] = {fresh(), fresh(), fresh()};
  join(state, kOne);
  state.on_message(kOne, Credit{1, 0, 0}, now_, out_);
  deliver(state, kOne, 1, {0});
  state.on_message(kOne, Bye{}, now_, out_);
  for (const WorkerId& holder : holders) {
    for (const WorkerId& id : state.workers()) state.on_message(id, Heartbeat{{}, {1, 2, 3, 4}}, now_, out_);
    join(state, holder);
    state.on_message(holder, Credit{1, 0, 0}, now_, out_);
    ASSERT_EQ(out_.all<Lease>(holder).size(), 1U);
    EXPECT_EQ(out_.all<Lease>(holder)[0].first, 1U) << "a copy";
    now_ += milliseconds(800);
  }
  for (int i = 0; i < 20; ++i) state.on_tick(now_ += milliseconds(100), out_);
  EXPECT_TRUE(state.workers().empty()) << "a cable was pulled";
  EXPECT_EQ(state.counters().quarantined, 0U);
  die(state);
  EXPECT_EQ(state.counters().quarantined, 0U);
  die(state);
  EXPECT_EQ(state.counters().quarantined, 1U) << "three in a row";
}

TEST_F(Killers, ATrialThatThrowsIsQuarantinedWithWhatItThrew) {
  CampaignState state = make(1);
  for (int i = 0; i < 3; ++i) {
    const WorkerId worker = fresh();
    join(state, worker);
    state.on_message(worker, Credit{1, 0, 0}, now_, out_);
    state.on_message(worker, Refused{Refused::Code::trial_threw, "trial 0 threw: no memory"}, now_, out_);
    state.on_gone(worker, "exit code 1", now_, out_);  // the process ends, too: one death
  }
  ASSERT_EQ(out_.requests.size(), 1U);
  EXPECT_EQ(out_.requests[0].rows[0].row.detail,
            "killed its worker 3 times, at last: trial 0 threw: no memory");
}

}  // namespace
}  // namespace fatmc
