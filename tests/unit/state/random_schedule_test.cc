// Random schedules: messages are lost, repeated and reordered, workers and the coordinator crash. Whatever
// happens, what was acknowledged is stored, nothing is stored twice, and once the trouble ends the run ends.
#include <gtest/gtest.h>

#include <deque>
#include <random>
#include <set>

#include "coordinator/state/campaign_state.h"

namespace fatmc {
namespace {

using std::chrono::milliseconds;

constexpr std::uint64_t kRepetitions[] = {60, 25};
constexpr milliseconds kStep{50};
constexpr milliseconds kTrouble{40'000};
constexpr milliseconds kEnd{200'000};

struct Letter {
  MonotonicTime due;
  WorkerId worker;
  Message message;
};

/// The conversation of docs/protocol.md from the worker's side, a trial a step.
struct ModelWorker {
  WorkerId id;
  bool welcomed = false;
  MonotonicTime last_hello{-1'000'000'000}, last_beat{};
  std::uint64_t newest = 0, sequence = 1;
  std::deque<std::pair<std::uint64_t, TrialKey>> queue;
  std::map<std::uint64_t, std::uint64_t> leases;
  std::map<std::uint64_t, std::pair<Results, std::uint64_t>> unacknowledged;  // -> and its lease
};

class World final : public Outbox {
 public:
  explicit World(std::uint64_t seed) : random_(seed) {
    for (int i = 0; i < 3; ++i) start_worker(i);
    start_coordinator();
  }
  void run();

 private:
  bool chance(double p) { return trouble() && std::uniform_real_distribution<>()(random_) < p; }
  [[nodiscard]] bool trouble() const { return now_ < kTrouble; }
  WorkerId fresh_id() {
    std::string id = std::to_string(++ids_);
    return std::string(32 - id.size(), '0') + id;
  }
  void start_worker(int i) { workers_[i] = ModelWorker{}, workers_[i].id = fresh_id(); }
  void start_coordinator();
  void post(std::vector<Letter>& box, const WorkerId& worker, const Message& message);
  void send(const WorkerId& worker, const Message& message) override;
  void store(StoreRequest request) override { batch_.push_back(std::move(request)); }
  void commit();
  void step_worker(ModelWorker& worker);
  void hear(ModelWorker& worker, const Message& message);
  template <typename Use>
  void deliver(std::vector<Letter>& box, Use use);

  std::mt19937_64 random_;
  MonotonicTime now_{0};
  int ids_ = 0;
  std::uint64_t first_lease_ = 1;
  ModelWorker workers_[3];
  std::optional<CampaignState> state_;
  std::vector<Letter> to_coordinator_, to_workers_;
  std::vector<StoreRequest> batch_;
  std::map<TrialKey, Sha256> database_;
  std::map<std::pair<WorkerId, std::uint64_t>, std::vector<TrialKey>> sent_;
};

void World::start_coordinator() {
  std::vector<PlanCell> plan;
  for (const std::uint64_t repetitions : kRepetitions) plan.push_back({repetitions, {}});
  for (const auto& [key, hash] : database_) plan[key.cell].stored.insert(key.repetition);
  StateOptions options;
  options.first_lease = first_lease_ += 1'000'000;
  batch_.clear();
  state_.emplace(std::move(plan), Welcome{"campaign", Tree{}, 0}, "build", options);
}

void World::post(std::vector<Letter>& box, const WorkerId& worker, const Message& message) {
  if (chance(0.1)) return;
  for (int copies = chance(0.1) ? 2 : 1; copies > 0; --copies) {
    const auto delay = milliseconds(trouble() ? random_() % 400 : 1);
    box.push_back({now_ + delay, worker, message});
  }
}

void World::send(const WorkerId& worker, const Message& message) {
  if (const auto* ack = std::get_if<Ack>(&message)) {
    for (const TrialKey& key : sent_.at({worker, ack->sequence})) {
      ASSERT_TRUE(database_.contains(key)) << "acknowledged before it was stored";
    }
  }
  post(to_workers_, worker, message);
}

void World::commit() {
  std::vector<StoreRequest> batch;
  batch.swap(batch_);
  for (const StoreRequest& request : batch) {
    StoreReport report{request.worker, request.sequence, {}};
    for (const ComputedRow& row : request.rows) {
      const auto [entry, is_new] = database_.emplace(row.row.key, row.hash);
      const bool same = entry->second == row.hash;
      report.rows.emplace_back(row.row.key, is_new ? StoreOutcome::stored
                                            : same ? StoreOutcome::duplicate
                                                   : StoreOutcome::conflict);
    }
    state_->on_stored(report, now_, *this);
  }
}

void World::hear(ModelWorker& worker, const Message& message) {
  if (std::holds_alternative<Welcome>(message) && !worker.welcomed) {
    worker.welcomed = true;
    worker.queue.clear();
    worker.leases.clear();
    worker.newest = 0;
    for (auto& [sequence, batch] : worker.unacknowledged) post(to_coordinator_, worker.id, batch.first);
  } else if (const auto* refused = std::get_if<Refused>(&message)) {
    ASSERT_EQ(refused->code, Refused::Code::hello_wanted);
    worker.welcomed = false;
  } else if (const auto* lease = std::get_if<Lease>(&message)) {
    if (!worker.welcomed || worker.leases.contains(lease->lease)) return;
    worker.newest = std::max(worker.newest, lease->lease);
    worker.leases[lease->lease] = lease->last - lease->first;
    for (std::uint64_t i = lease->first; i < lease->last; ++i) {
      worker.queue.push_back({lease->lease, {lease->cell, i}});
    }
  } else if (const auto* ack = std::get_if<Ack>(&message)) {
    const auto batch = worker.unacknowledged.find(ack->sequence);
    if (batch == worker.unacknowledged.end()) return;
    const auto held = worker.leases.find(batch->second.second);
    if (held != worker.leases.end() && --held->second == 0) worker.leases.erase(held);
    worker.unacknowledged.erase(batch);
  }
}

void World::step_worker(ModelWorker& worker) {
  if (!worker.welcomed) {
    if (now_ - worker.last_hello < milliseconds(1000)) return;
    worker.last_hello = now_;
    return post(to_coordinator_, worker.id, Hello{kProtocolVersion, "build", worker.id, "host", 1, 1});
  }
  if (!worker.queue.empty()) {
    const auto [lease, key] = worker.queue.front();
    worker.queue.pop_front();
    ComputedRow row;
    row.row.key = key;
    row.hash = content_hash(row.row);
    row.duration_ns = 50'000'000;
    const Results results{"campaign", worker.sequence++, {row}};
    sent_[{worker.id, results.sequence}] = {key};
    worker.unacknowledged[results.sequence] = {results, lease};
    post(to_coordinator_, worker.id, results);
  }
  const Credit credit{worker.queue.empty() ? 1U : 0U, worker.queue.size(), worker.newest};
  if (worker.queue.empty()) post(to_coordinator_, worker.id, credit);
  if (now_ - worker.last_beat < milliseconds(500)) return;
  worker.last_beat = now_;
  Heartbeat beat{credit, {}};
  for (const auto& [lease, rows] : worker.leases) beat.leases.push_back(lease);
  post(to_coordinator_, worker.id, beat);
  for (auto& [sequence, batch] : worker.unacknowledged) post(to_coordinator_, worker.id, batch.first);
}

template <typename Use>
void World::deliver(std::vector<Letter>& box, Use use) {
  std::vector<Letter> due;
  std::erase_if(box, [&](Letter& letter) {
    if (letter.due > now_) return false;
    due.push_back(std::move(letter));
    return true;
  });
  std::stable_sort(due.begin(), due.end(), [](const Letter& a, const Letter& b) { return a.due < b.due; });
  for (const Letter& letter : due) use(letter);
}

void World::run() {
  while (now_ < kEnd && !(state_->finished() && !trouble())) {
    now_ += kStep;
    if (chance(0.004)) start_coordinator();
    for (int i = 0; i < 3; ++i) {
      if (!chance(0.01)) continue;
      if (chance(0.5)) state_->on_gone(workers_[i].id, now_, *this);  // else it is found out by silence
      start_worker(i);
    }
    deliver(to_coordinator_, [&](const Letter& l) { state_->on_message(l.worker, l.message, now_, *this); });
    deliver(to_workers_, [&](const Letter& letter) {
      for (ModelWorker& worker : workers_) {
        if (worker.id == letter.worker) hear(worker, letter.message);
      }
    });
    for (ModelWorker& worker : workers_) step_worker(worker);
    if (!chance(0.5)) commit();
    state_->on_tick(now_, *this);
  }
  EXPECT_TRUE(state_->finished()) << "stored " << state_->stored() << " of " << state_->planned();
  EXPECT_EQ(database_.size(), kRepetitions[0] + kRepetitions[1]);
  EXPECT_EQ(state_->stored(), database_.size());
  EXPECT_EQ(state_->counters().conflicts, 0U);
  EXPECT_EQ(state_->counters().out_of_plan, 0U);
}

class RandomSchedule : public testing::TestWithParam<std::uint64_t> {};

TEST_P(RandomSchedule, StoresWhatItAcknowledgesOnceAndEnds) { World(GetParam()).run(); }

INSTANTIATE_TEST_SUITE_P(Seeds, RandomSchedule, testing::Range<std::uint64_t>(1, 101));

}  // namespace
}  // namespace fatmc
