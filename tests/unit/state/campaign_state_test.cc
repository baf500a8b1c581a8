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

// ---- trials that kill their workers

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

// ---- copies at the tail

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

// ---- a database that cannot be written

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
