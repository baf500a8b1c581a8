// The compute threads of a worker: a queue of leased trials in, computed rows out.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "campaigns/base/study.h"
#include "proto/wire.h"

namespace fatmc {

/// A campaign as a worker knows it. Cells are prepared when their first trial comes, once, whatever the
/// number of threads; a cell that is prepared is const.
class LoadedCampaign {
 public:
  /// Decodes the spec and finds its study.
  static Result<std::shared_ptr<LoadedCampaign>> load(std::string id, const Tree& tree);

  /// Computes one row; the error is that of prepare(). What a trial throws passes through.
  Result<ComputedRow> run(TrialKey key);

  [[nodiscard]] const std::string& id() const { return id_; }
  /// Whether its cell exists. Repetitions have no end here: the coordinator may extend a cell while it runs.
  [[nodiscard]] bool holds(const Lease& lease) const;

 private:
  struct Prepared {
    std::mutex mutex;
    std::unique_ptr<PreparedCell> cell;
    std::optional<Error> error;
  };
  Result<const PreparedCell*> prepared(std::uint32_t cell);

  std::string id_;
  CampaignSpec spec_;
  const TrialStudy* study_ = nullptr;
  std::vector<std::unique_ptr<Prepared>> cells_;
};

struct FinishedRow {
  std::uint64_t lease = 0;
  std::string campaign;
  ComputedRow row;
};

/// What the I/O thread finds when it looks.
struct RunnerNews {
  std::vector<FinishedRow> rows;
  std::uint32_t idle = 0;
  std::uint64_t queued = 0;
  std::optional<Refused> failure;  ///< the worker cannot go on
};

/// All members may be called from any thread; in practice all but the compute threads' own are the I/O
/// thread's.
class TrialRunner {
 public:
  /// Starts `jobs` threads. `wake_descriptor` is an eventfd that is written when there is news.
  TrialRunner(unsigned jobs, int wake_descriptor);
  /// Waits for trials that are running; see abandon().
  ~TrialRunner();
  TrialRunner(const TrialRunner&) = delete;
  TrialRunner& operator=(const TrialRunner&) = delete;

  void push(std::shared_ptr<LoadedCampaign> campaign, const Lease& lease);
  /// Forgets trials that have not begun.
  void clear();
  RunnerNews take_news();
  /// Whether no trial is running.
  [[nodiscard]] bool idle();

 private:
  struct Work {
    std::shared_ptr<LoadedCampaign> campaign;
    Lease rest;  ///< trials not begun
  };
  struct Job {
    std::shared_ptr<LoadedCampaign> campaign;
    std::uint64_t lease = 0;
    TrialKey key;
  };

  void work();
  void compute(const Job& job);
  void wake();  // with mutex_ held

  const int wake_descriptor_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Work> queue_;
  std::uint64_t queued_ = 0;
  std::uint32_t running_ = 0;
  bool stop_ = false;
  bool woken_ = false;
  std::vector<FinishedRow> finished_;
  std::optional<Refused> failure_;
  std::vector<std::thread> threads_;
};

}  // namespace fatmc
