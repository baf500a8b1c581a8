#include "tests/simulation/simulated_campaign.h"

#include <algorithm>
#include <utility>

#include "coordinator/store/storage_trouble.h"

namespace fatmc::simulation {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kStep{50};
constexpr milliseconds kTrouble{15'000};
constexpr milliseconds kEnd{120'000};  // of the slowest schedules ten times what they need
constexpr int kWorkers = 3;
constexpr int kRepetitions[] = {40, 25};

Tree value(auto content) { return Tree{std::move(content), "simulation", 1}; }

CampaignSpec make_spec() {
  Tree campaign = value(Tree::Table{}), cells = value(Tree::Array{}), tree = campaign;
  campaign.set("study", value(std::string("engine_test")));
  campaign.set("seed", value(std::int64_t{5}));
  for (const int repetitions : kRepetitions) {
    Tree cell = value(Tree::Table{});
    cell.set("name", value("cell" + std::to_string(repetitions)));
    cell.set("repetitions", value(std::int64_t{repetitions}));
    cell.set("diverge_every", value(std::int64_t{7}));
    cell.set("array", value(std::int64_t{3}));
    std::get<Tree::Array>(cells.value).items.push_back(std::move(cell));
  }
  tree.set("campaign", campaign);
  tree.set("cell", cells);
  return *decode_campaign(tree);
}

Time worker_time(MonotonicTime now) { return Time(std::chrono::duration_cast<Time::duration>(now)); }

}  // namespace

SimulatedCampaign::SimulatedCampaign(std::uint64_t seed) : random_(seed), spec_(make_spec()) {
  const auto uniform = [this] { return std::uniform_real_distribution<>()(random_); };
  // Each schedule has a mixture of its own, so that rare faults also meet a world that is otherwise calm.
  calm_ = uniform() < 0.2;
  loss_ = calm_ ? 0.0 : 0.3 * uniform() * uniform();
  worker_death_ = calm_ ? 0.0 : 0.04 * uniform() * uniform();
  coordinator_death_ = 0.02 * uniform() * uniform();
  commit_failure_ = 0.5 * uniform() * uniform() * uniform();
  if (uniform() < 0.3) deadly_ = TrialKey{static_cast<std::uint32_t>(random_() % 2), random_() % 25};
  workers_.resize(kWorkers);
  start_coordinator();
  for (WorkerSlot& slot : workers_) start_worker(slot);
}

bool SimulatedCampaign::trouble() const { return now_ < kTrouble; }

bool SimulatedCampaign::chance(double probability) {
  return trouble() && std::uniform_real_distribution<>()(random_) < probability;
}

MonotonicTime SimulatedCampaign::within(int longest) {
  return now_ + milliseconds(random_() % static_cast<std::uint64_t>(longest));
}

void SimulatedCampaign::start_coordinator() {
  std::vector<PlanCell> plan;
  for (const int repetitions : kRepetitions) {
    PlanCell cell;
    cell.repetitions = static_cast<std::uint64_t>(repetitions);
    plan.push_back(cell);
  }
  for (const auto& [key, row] : disk_) plan[key.cell].stored.insert(key.repetition);
  StateOptions options;
  options.first_lease = first_lease_ += 1'000'000;
  if (state_) {
    history_.copies += state_->counters().copied;
    history_.duplicates += state_->counters().duplicates;
  }
  state_.emplace(std::move(plan), Welcome{spec_.identity(), spec_.tree, 0}, "build", options);
  commits_.emplace(GroupCommitOptions{},
                   [this](std::span<const StoreRequest> batch) { return write(batch); });
  coordinator_is_dead_ = false;
}

void SimulatedCampaign::start_worker(WorkerSlot& slot) {
  std::string id = std::to_string(++ids_);
  id.insert(0, 32 - id.size(), '0');
  const int steps = random_() % 4 == 0 ? 20 : 2;  // every fourth is ten times slower
  slot = {};
  slot.process = std::make_unique<SimulatedWorker>(
      id, steps, worker_time(now_), [this](const std::string& worker, const std::string& frame) {
        const Result<Message> message = decode(frame);
        if (const auto* results = std::get_if<Results>(&*message)) {
          std::vector<TrialKey>& keys = sent_[{worker, results->sequence}];
          keys.clear();
          for (const ComputedRow& row : results->rows) keys.push_back(row.row.key);
        }
        post(to_coordinator_, worker, frame);
      });
}

bool SimulatedCampaign::is_cut_off(const WorkerId& worker) const {
  return std::any_of(workers_.begin(), workers_.end(), [&](const WorkerSlot& slot) {
    return slot.process && slot.process->incarnation() == worker && slot.cut_off_until > now_;
  });
}

void SimulatedCampaign::post(std::vector<Letter>& box, const WorkerId& worker, const std::string& frame) {
  if (is_cut_off(worker) || chance(loss_)) {
    ++history_.messages_lost;
    return;
  }
  for (int copies = !calm_ && chance(0.1) ? 2 : 1; copies > 0; --copies)
    box.push_back({trouble() && !calm_ ? within(chance(0.1) ? 3000 : 200) : now_, worker, frame});
}

void SimulatedCampaign::send(const WorkerId& worker, const Message& message) {
  if (const auto* ack = std::get_if<Ack>(&message)) {
    const auto rows = sent_.find({worker, ack->sequence});
    if (rows == sent_.end()) {
      history_.violations.emplace_back("an ACK for rows that nobody sent");
    } else {
      for (const TrialKey& key : rows->second)
        if (!disk_.contains(key)) history_.violations.emplace_back("an ACK for a row that is not on disk");
    }
  }
  post(to_workers_, worker, encode(message));
}

// One transaction. It may fail, and the machine may die in it: before the sync all of it is lost, after it
// all of it is there although nobody was told.
std::vector<StoreReport> SimulatedCampaign::write(std::span<const StoreRequest> batch) {
  if (chance(commit_failure_)) disk_full_until_ = within(3000);
  if (disk_full_until_ > now_) {
    ++history_.failed_commits;
    throw StorageTrouble("the simulated disk is full");
  }
  if (chance(0.02)) {
    ++history_.power_cuts;
    coordinator_is_dead_ = true;
    if (chance(0.5)) return {};
  }
  std::vector<StoreReport> reports;
  for (const StoreRequest& request : batch) {
    StoreReport report{request.worker, request.sequence, {}};
    for (const ComputedRow& row : request.rows) {
      const auto [entry, is_new] = disk_.emplace(row.row.key, row);
      StoreOutcome outcome = StoreOutcome::stored;
      if (!is_new) {
        outcome = entry->second.hash == row.hash || row.row.outcome == kQuarantined ? StoreOutcome::duplicate
                                                                                    : StoreOutcome::conflict;
        if (outcome == StoreOutcome::conflict && entry->second.row.outcome == kQuarantined) {
          entry->second = row;
          outcome = StoreOutcome::stored;
        }
      }
      report.rows.emplace_back(row.row.key, outcome);
    }
    reports.push_back(std::move(report));
  }
  if (coordinator_is_dead_) return {};  // synced, and nobody was told
  return reports;
}

// As CampaignServer::commit() does it.
void SimulatedCampaign::commit() {
  const bool was_in_trouble = !commits_->trouble().empty();
  for (const StoreReport& report : commits_->commit(now_)) state_->on_stored(report, now_, *this);
  const bool is_in_trouble = !commits_->trouble().empty();
  if (is_in_trouble && !was_in_trouble) state_->hold_dispatch();
  if (was_in_trouble && !is_in_trouble) state_->release_dispatch(now_, *this);
}

void SimulatedCampaign::strike() {
  if (!coordinator_is_dead_ && chance(coordinator_death_)) coordinator_is_dead_ = true;
  if (coordinator_is_dead_ && commits_) {
    ++history_.coordinator_deaths;
    commits_.reset();
    to_coordinator_.clear();  // connections die with their process
    coordinator_starts_at_ = within(4000) + kStep;
  }
  for (WorkerSlot& slot : workers_) {
    if (!slot.process) continue;
    if (chance(worker_death_)) {
      ++history_.worker_deaths;
      const WorkerId id = slot.process->incarnation();
      slot.process.reset();
      slot.starts_at = within(2000);
      // Its own coordinator sees the process end; of others it is found out by silence.
      if (commits_ && chance(0.5)) state_->on_gone(id, "signal Killed", now_, *this);
    } else if (calm_) {
      continue;
    } else if (chance(0.004)) {
      slot.stopped_until = within(5000);
    } else if (chance(0.004)) {
      slot.cut_off_until = within(5000);
    }
  }
}

void SimulatedCampaign::deliver() {
  const auto due_of = [this](std::vector<Letter>& box) {
    std::vector<Letter> due;
    std::erase_if(box, [&](Letter& letter) {
      if (letter.due > now_) return false;
      due.push_back(std::move(letter));
      return true;
    });
    std::stable_sort(due.begin(), due.end(), [](const Letter& a, const Letter& b) { return a.due < b.due; });
    return due;
  };
  for (Letter& letter : due_of(to_coordinator_)) {
    Result<Message> message = decode(letter.frame);
    if (!commits_ || coordinator_is_dead_ || !message) continue;
    // As CampaignServer::receive() does it.
    if (!commits_->trouble().empty() && std::holds_alternative<Results>(*message)) continue;
    state_->on_message(letter.worker, std::move(*message), now_, *this);
  }
  for (const Letter& letter : due_of(to_workers_)) {
    for (WorkerSlot& slot : workers_) {
      if (slot.process && slot.process->incarnation() == letter.worker && slot.stopped_until <= now_)
        slot.process->receive(letter.frame, worker_time(now_));
    }
  }
}

void SimulatedCampaign::step_workers() {
  for (WorkerSlot& slot : workers_) {
    if (!slot.process) {
      if (slot.starts_at <= now_ && !state_->finished()) start_worker(slot);
      continue;
    }
    if (slot.stopped_until > now_) continue;
    if (slot.process->step(worker_time(now_), [this](TrialKey key) { return is_deadly(key); })) continue;
    ++history_.worker_deaths;
    const WorkerId id = slot.process->incarnation();
    slot.process.reset();
    slot.starts_at = now_ + milliseconds(100);
    if (commits_ && random_() % 2 == 0) state_->on_gone(id, "signal Aborted", now_, *this);
  }
}

void SimulatedCampaign::coordinate() {
  if (coordinator_is_dead_) {
    if (coordinator_starts_at_ > now_ || commits_) return;
    start_coordinator();
    for (WorkerSlot& slot : workers_) {
      if (slot.process && slot.stopped_until <= now_) slot.process->reconnected(worker_time(now_));
    }
    return;
  }
  if (commits_->is_due(now_) || (state_->all_received() && commits_->may_try(now_))) commit();
  if (!coordinator_is_dead_ && now_.count() % milliseconds(100).count() == 0) state_->on_tick(now_, *this);
}

void SimulatedCampaign::check_end() {
  history_.copies += state_->counters().copied;
  history_.duplicates += state_->counters().duplicates;
  if (!state_->finished() || coordinator_is_dead_) {
    history_.violations.push_back("not finished: " + std::to_string(state_->stored()) + " of " +
                                  std::to_string(state_->planned()) + " stored");
    return;
  }
  auto campaign = *LoadedCampaign::load(spec_.identity(), spec_.tree);
  Digest expected, found;
  for (std::uint32_t cell = 0; cell < spec_.cells.size(); ++cell) {
    for (std::uint64_t i = 0; i < spec_.cells[cell].repetitions; ++i) {
      const auto row = disk_.find({cell, i});
      if (row == disk_.end()) {
        history_.violations.emplace_back("a trial without a row");
        continue;
      }
      ++history_.trials;
      if (row->second.row.outcome == kQuarantined) {
        // With workers dying all the time, three may die over an innocent trial; a calm world may give up
        // none but the deadly one.
        ++history_.quarantined;
        if (calm_ && !is_deadly({cell, i}))
          history_.violations.emplace_back("an innocent trial was given up");
        continue;
      }
      if (is_deadly({cell, i})) history_.violations.emplace_back("a result of the deadly trial");
      expected.add(spec_.cells[cell].name, campaign->run({cell, i})->row);
      found.add(spec_.cells[cell].name, row->second.row);
    }
  }
  if (disk_.size() != history_.trials) history_.violations.emplace_back("rows of no trial");
  if (expected.text() != found.text()) history_.violations.emplace_back("another digest than without faults");
}

History SimulatedCampaign::run() {
  while (now_ < kEnd && !(state_->finished() && !trouble() && !coordinator_is_dead_)) {
    now_ += kStep;
    ++history_.steps;
    strike();
    deliver();
    step_workers();
    coordinate();
  }
  check_end();
  return history_;
}

}  // namespace fatmc::simulation
