#include "coordinator/server/group_commit.h"

#include <algorithm>
#include <utility>

#include "coordinator/store/storage_trouble.h"

namespace fatmc {

void GroupCommit::add(StoreRequest request, MonotonicTime now) {
  if (batch_.empty()) since_ = now;
  rows_ += request.rows.size();
  batch_.push_back(std::move(request));
}

bool GroupCommit::is_due(MonotonicTime now) const {
  if (batch_.empty()) return false;
  if (!trouble_.empty()) return now >= retry_at_;
  return rows_ >= options_.rows || now - since_ >= options_.wait;
}

std::chrono::milliseconds GroupCommit::until_due(MonotonicTime now) const {
  const MonotonicTime due = trouble_.empty() ? since_ + options_.wait : retry_at_;
  return std::max(std::chrono::ceil<std::chrono::milliseconds>(due - now), std::chrono::milliseconds(0));
}

std::vector<StoreReport> GroupCommit::commit(MonotonicTime now) {
  if (batch_.empty()) return {};
  std::vector<StoreReport> reports;
  try {
    reports = write_(batch_);
  } catch (const StorageTrouble& e) {
    trouble_ = e.what();
    retry_at_ = now + options_.retry;
    return {};
  }
  trouble_.clear();
  batch_.clear();
  rows_ = 0;
  return reports;
}

}  // namespace fatmc
