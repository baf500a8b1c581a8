// Rows on their way to the coordinator: gathered into batches, kept until acknowledged, sent again when
// overdue.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "worker/trial_runner.h"

namespace fatmc {

/// Used by the I/O thread alone.
class ResultOutbox {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit ResultOutbox(std::function<void(const std::string& frame)> send) : send_(std::move(send)) {}

  void add(FinishedRow row) { rows_.push_back(std::move(row)); }
  /// Forgets all rows, sent or not: those of another campaign.
  void clear();
  /// Whether rows wait to be sent for the first time.
  [[nodiscard]] bool has_unsent() const { return !rows_.empty(); }
  /// When those are to be sent at the latest.
  [[nodiscard]] Time due() const;
  /// Whether there are enough, or they have waited long enough.
  [[nodiscard]] bool is_due(Time now) const;
  /// Sends them as RESULTS of that campaign, no message with more rows or bytes than the protocol wants.
  void flush(const std::string& campaign, Time now);
  /// Forgets an acknowledged message; the number of its rows by lease, empty when it is not known.
  std::map<std::uint64_t, std::uint64_t> acknowledge(std::uint64_t sequence);
  /// Sends again what is not acknowledged: all of it, or what has waited too long.
  void resend(bool overdue_only, Time now);

 private:
  struct Batch {
    std::string frame;
    std::map<std::uint64_t, std::uint64_t> rows_of_lease;
    Time sent;
  };
  using Row = std::vector<FinishedRow>::iterator;
  void send_batch(const std::string& campaign, Row first, Row last, Time now);

  std::function<void(const std::string&)> send_;
  std::vector<FinishedRow> rows_;
  std::map<std::uint64_t, Batch> unacknowledged_;  // by sequence
  std::uint64_t next_sequence_ = 1;
  Time last_flush_{};
};

}  // namespace fatmc
