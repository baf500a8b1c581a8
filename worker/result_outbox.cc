#include "worker/result_outbox.h"

#include <utility>

namespace fatmc {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kResendAfter{3000};  // a commit takes milliseconds; a loss is rare
constexpr milliseconds kBatchFor{5};        // rows of very short trials travel together

std::size_t rough_size(const ComputedRow& row) {
  std::size_t size = 128 + row.row.detail.size() + 32 * row.row.metrics.size();
  for (const auto& [name, values] : row.row.arrays) size += name.size() + 16 + 8 * values.size();
  return size;
}

}  // namespace

void ResultOutbox::clear() {
  rows_.clear();
  unacknowledged_.clear();
}

ResultOutbox::Time ResultOutbox::due() const { return last_flush_ + kBatchFor; }

bool ResultOutbox::is_due(Time now) const { return rows_.size() >= kMaxRowsPerMessage || now >= due(); }

void ResultOutbox::flush(const std::string& campaign, Time now) {
  auto first = rows_.begin();
  while (first != rows_.end()) {
    std::size_t bytes = rough_size(first->row);
    auto last = first + 1;
    while (last != rows_.end() && static_cast<std::size_t>(last - first) < kMaxRowsPerMessage &&
           (bytes += rough_size(last->row)) < kResultsTargetBytes) {
      ++last;
    }
    send_batch(campaign, first, last, now);
    first = last;
  }
  rows_.clear();
  last_flush_ = now;
}

void ResultOutbox::send_batch(const std::string& campaign, Row first, Row last, Time now) {
  Results results{campaign, next_sequence_++, {}};
  Batch batch;
  for (auto row = first; row != last; ++row) {
    ++batch.rows_of_lease[row->lease];
    results.rows.push_back(std::move(row->row));
  }
  batch.frame = encode(results);
  batch.sent = now;
  send_(batch.frame);
  unacknowledged_.emplace(results.sequence, std::move(batch));
}

std::map<std::uint64_t, std::uint64_t> ResultOutbox::acknowledge(std::uint64_t sequence) {
  const auto batch = unacknowledged_.extract(sequence);
  if (batch.empty()) return {};
  return std::move(batch.mapped().rows_of_lease);
}

void ResultOutbox::resend(bool overdue_only, Time now) {
  for (auto& [sequence, batch] : unacknowledged_) {
    if (overdue_only && now - batch.sent < kResendAfter) continue;
    batch.sent = now;
    send_(batch.frame);
  }
}

}  // namespace fatmc
