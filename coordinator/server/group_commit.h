// Rows on their way to the database: gathered, committed together, kept while the database cannot take them.
#pragma once

#include <chrono>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "coordinator/state/campaign_state.h"

namespace fatmc {

struct GroupCommitOptions {
  std::size_t rows = kMaxRowsPerMessage;
  /// What waits in the socket meanwhile joins the batch, up to this: on a disk that is slow to sync, more rows
  /// share one fsync.
  std::size_t most_rows = 10 * kMaxRowsPerMessage;
  std::chrono::milliseconds wait{50};
  /// How soon a commit is tried again that failed because the disk was full or broken.
  std::chrono::milliseconds retry{500};
};

class GroupCommit {
 public:
  /// One transaction, on disk when it returns; throws StorageTrouble when nothing of it is stored. May take
  /// the requests with it when it succeeds.
  using Write = std::function<std::vector<StoreReport>(std::span<StoreRequest>)>;

  GroupCommit(const GroupCommitOptions& options, Write write) : options_(options), write_(std::move(write)) {}

  void add(StoreRequest request, MonotonicTime now);
  [[nodiscard]] bool empty() const { return batch_.empty(); }
  /// Enough rows, or the oldest has waited long enough; in trouble, when it is time to try again.
  [[nodiscard]] bool is_due(MonotonicTime now) const;
  /// So many rows that no more should join, be there some or not; in trouble as is_due().
  [[nodiscard]] bool is_full(MonotonicTime now) const { return rows_ >= options_.most_rows && is_due(now); }
  [[nodiscard]] std::chrono::milliseconds until_due(MonotonicTime now) const;
  /// Writes what is there; what became of it, or nothing while the database cannot take it.
  std::vector<StoreReport> commit(MonotonicTime now);
  /// Why the last commit failed; empty when it did not.
  [[nodiscard]] const std::string& trouble() const { return trouble_; }
  /// Whether a commit makes sense now, be it due or not.
  [[nodiscard]] bool may_try(MonotonicTime now) const { return trouble_.empty() || now >= retry_at_; }

 private:
  GroupCommitOptions options_;
  Write write_;
  std::vector<StoreRequest> batch_;
  std::size_t rows_ = 0;
  MonotonicTime since_{}, retry_at_{};
  std::string trouble_;
};

}  // namespace fatmc
