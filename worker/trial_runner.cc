#include "worker/trial_runner.h"

#include <unistd.h>

#include <chrono>
#include <exception>

#include "campaigns/base/prepared_trials.h"
#include "campaigns/registry_trials.h"
#include "core/base/check.h"

namespace fatmc {

Result<std::shared_ptr<LoadedCampaign>> LoadedCampaign::load(std::string id, const Tree& tree) {
  Result<CampaignSpec> spec = decode_campaign(tree);
  if (!spec) return fail(spec.error());
  const Result<const TrialStudy*> study = require_trial_study(*spec);
  if (!study) return fail(study.error());
  auto campaign = std::make_shared<LoadedCampaign>();
  campaign->id_ = std::move(id);
  campaign->study_ = *study;
  for (std::size_t i = 0; i < spec->cells.size(); ++i)
    campaign->cells_.push_back(std::make_unique<Prepared>());
  campaign->spec_ = std::move(*spec);
  return campaign;
}

bool LoadedCampaign::holds(const Lease& lease) const { return lease.cell < spec_.cells.size(); }

Result<const PreparedCell*> LoadedCampaign::prepared(std::uint32_t cell) {
  Prepared& own = *cells_[cell];
  const std::lock_guard lock(own.mutex);
  if (own.error) return fail(*own.error);
  if (own.cell == nullptr) {
    auto made = prepare_trials(*study_, spec_, cell);
    if (!made) {
      own.error = made.error();
      return fail(made.error());
    }
    own.cell = std::move(*made);
  }
  return own.cell.get();
}

Result<ComputedRow> LoadedCampaign::run(TrialKey key) {
  const Result<const PreparedCell*> cell = prepared(key.cell);
  if (!cell) return fail(cell.error());
  const auto started = std::chrono::system_clock::now().time_since_epoch();
  const auto begin = std::chrono::steady_clock::now();
  ComputedRow out;
  out.row = (*cell)->run(key.repetition);
  const auto end = std::chrono::steady_clock::now();
  out.row.key = key;
  out.hash = content_hash(out.row);
  out.started_us =
      static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::microseconds>(started).count());
  out.duration_ns =
      static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(end - begin).count());
  return out;
}

TrialRunner::TrialRunner(unsigned jobs, int wake_descriptor) : wake_descriptor_(wake_descriptor) {
  for (unsigned i = 0; i < jobs; ++i) threads_.emplace_back([this] { work(); });
}

TrialRunner::~TrialRunner() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void TrialRunner::push(std::shared_ptr<LoadedCampaign> campaign, const Lease& lease) {
  {
    const std::lock_guard lock(mutex_);
    queued_ += lease.last - lease.first;
    queue_.push_back({std::move(campaign), lease});
  }
  changed_.notify_all();
}

void TrialRunner::clear() {
  const std::lock_guard lock(mutex_);
  queue_.clear();
  queued_ = 0;
}

RunnerNews TrialRunner::take_news() {
  const std::lock_guard lock(mutex_);
  woken_ = false;
  RunnerNews news;
  news.rows.swap(finished_);
  // A thread that has not yet taken its queued trial is as good as busy.
  const std::uint64_t busy = running_ + queued_;
  news.idle = busy >= threads_.size() ? 0U : static_cast<std::uint32_t>(threads_.size() - busy);
  news.queued = queued_ > threads_.size() - running_ ? queued_ - (threads_.size() - running_) : 0;
  news.failure = failure_;
  return news;
}

bool TrialRunner::idle() {
  const std::lock_guard lock(mutex_);
  return running_ == 0;
}

void TrialRunner::wake() {
  if (woken_) return;
  woken_ = true;
  const std::uint64_t one = 1;
  FATMC_CHECK(::write(wake_descriptor_, &one, sizeof one) == sizeof one, "an eventfd takes a write");
}

void TrialRunner::work() {
  for (;;) {
    Job job;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return stop_ || !queue_.empty(); });
      if (stop_) return;
      Work& front = queue_.front();
      job = {front.campaign, front.rest.lease, {front.rest.cell, front.rest.first}};
      if (++front.rest.first == front.rest.last) queue_.pop_front();
      ++running_;
      if (--queued_ == 0) wake();  // time to ask for more
    }
    compute(job);
  }
}

void TrialRunner::compute(const Job& job) {
  std::optional<ComputedRow> row;
  std::optional<Refused> failure;
  try {
    Result<ComputedRow> computed = job.campaign->run(job.key);
    if (computed) {
      row = std::move(*computed);
    } else {
      failure = Refused{Refused::Code::unusable_spec, computed.error().text()};
    }
  } catch (const std::exception& e) {
    failure =
        Refused{Refused::Code::trial_threw, "trial " + std::to_string(job.key.repetition) + " of cell " +
                                                std::to_string(job.key.cell) + " threw: " + e.what()};
  }
  const std::lock_guard lock(mutex_);
  --running_;
  if (row) finished_.push_back({job.lease, job.campaign->id(), std::move(*row)});
  if (failure) failure_ = std::move(failure);
  wake();
}

}  // namespace fatmc
