// Tables beside the results: what commands in other terminals want of a running coordinator, where trials are
// at this moment, and where the precision asked for ended a cell. docs/schema.md describes them.
//
// All writes are small transactions of their own; SQLite serialises them with those of the coordinator.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace SQLite {
class Database;
}

namespace fatmc {

/// What is wanted.
struct ControlState {
  bool paused = false;
  std::vector<std::uint64_t> repetitions;  ///< a number a cell
  bool operator==(const ControlState&) const = default;
};

/// A cell that ended by precision: rows from `repetitions` on are not of the campaign and were removed.
struct StopDecision {
  std::uint32_t cell = 0;
  std::uint64_t repetitions = 0;  ///< N, the first at which the interval was narrow enough
  std::string metric;
  double level = 0.0, mean = 0.0, low = 0.0, high = 0.0;
};

/// Trials that a worker holds for longer than usual.
struct TrialsInFlight {
  std::uint32_t cell = 0;
  std::uint64_t first = 0, last = 0;  ///< [first, last)
  std::uint64_t missing = 0;          ///< of these
  std::uint32_t attempts = 0;
  std::string host;
  std::uint32_t pid = 0;
  double held_s = 0.0;  ///< so far, at the time of `reported`
};

class ControlTables {
 public:
  /// `db` must outlive it. Nothing is read or written yet.
  explicit ControlTables(SQLite::Database& db) : db_(&db) {}

  /// Makes those that are missing.
  void create();
  [[nodiscard]] ControlState read() const;
  /// Whether another connection has written anything since the last call.
  [[nodiscard]] bool changed();

  void set_paused(bool paused);
  void set_repetitions(std::uint32_t cell, std::uint64_t repetitions);
  /// Stores the decision, plans the cell accordingly and removes rows beyond: one transaction.
  void stop(const StopDecision& decision);
  /// Forgets decisions, since the rule may be another now.
  void clear_stops();
  [[nodiscard]] std::vector<StopDecision> stops() const;

  /// Replaces all of them.
  void set_in_flight(const std::vector<TrialsInFlight>& trials);
  [[nodiscard]] std::vector<TrialsInFlight> in_flight() const;
  /// UTC time of the last set_in_flight(); empty when there was none.
  [[nodiscard]] std::string in_flight_reported() const;

 private:
  [[nodiscard]] bool has(const char* table) const;
  SQLite::Database* db_;
  std::int64_t version_ = -1;
};

}  // namespace fatmc
