#include "coordinator/store/control_tables.h"

#include <SQLiteCpp/SQLiteCpp.h>

#include "coordinator/store/schema.h"

namespace fatmc {

void ControlTables::create() { db_->exec(kControlSql); }

bool ControlTables::has(const char* table) const { return db_->tableExists(table); }

ControlState ControlTables::read() const {
  ControlState out;
  if (has("control"))
    out.paused = db_->execAndGet("SELECT coalesce(max(paused), 0) FROM control").getInt() != 0;
  SQLite::Statement cells(*db_, "SELECT repetitions FROM cell ORDER BY id");
  while (cells.executeStep())
    out.repetitions.push_back(static_cast<std::uint64_t>(cells.getColumn(0).getInt64()));
  return out;
}

bool ControlTables::changed() {
  const std::int64_t version = db_->execAndGet("PRAGMA data_version").getInt64();
  const bool changed = version != version_;
  version_ = version;
  return changed;
}

void ControlTables::set_paused(bool paused) {
  SQLite::Statement set(*db_,
                        "INSERT INTO control (id, paused) VALUES (1, ?) ON CONFLICT (id) DO UPDATE SET "
                        "paused = excluded.paused");
  set.bind(1, paused ? 1 : 0);
  set.exec();
}

void ControlTables::set_repetitions(std::uint32_t cell, std::uint64_t repetitions) {
  SQLite::Statement set(*db_, "UPDATE cell SET repetitions = ? WHERE id = ?");
  set.bind(1, static_cast<std::int64_t>(repetitions));
  set.bind(2, static_cast<std::int64_t>(cell));
  set.exec();
}

void ControlTables::stop(const StopDecision& decision) {
  SQLite::Transaction transaction(*db_, SQLite::TransactionBehavior::IMMEDIATE);
  SQLite::Statement insert(*db_, "INSERT OR REPLACE INTO stop VALUES (?, ?, ?, ?, ?, ?, ?)");
  insert.bind(1, static_cast<std::int64_t>(decision.cell));
  insert.bind(2, static_cast<std::int64_t>(decision.repetitions));
  insert.bind(3, decision.metric);
  insert.bind(4, decision.level);
  insert.bind(5, decision.mean);
  insert.bind(6, decision.low);
  insert.bind(7, decision.high);
  insert.exec();
  set_repetitions(decision.cell, decision.repetitions);
  for (const auto& [table, key] :
       {std::pair("trial", "id"), std::pair("metric", "trial"), std::pair("array", "trial")}) {
    SQLite::Statement drop(*db_, std::string("DELETE FROM ") + table + " WHERE " + key + " BETWEEN ? AND ?");
    drop.bind(1, trial_id({decision.cell, decision.repetitions}));
    drop.bind(2, trial_id({decision.cell + 1, 0}) - 1);
    drop.exec();
  }
  transaction.commit();
}

void ControlTables::clear_stops() { db_->exec("DELETE FROM stop"); }

std::vector<StopDecision> ControlTables::stops() const {
  std::vector<StopDecision> out;
  if (!has("stop")) return out;
  SQLite::Statement rows(*db_,
                         "SELECT cell, repetitions, metric, level, mean, low, high FROM stop ORDER BY cell");
  while (rows.executeStep()) {
    out.push_back({static_cast<std::uint32_t>(rows.getColumn(0).getInt64()),
                   static_cast<std::uint64_t>(rows.getColumn(1).getInt64()), rows.getColumn(2).getString(),
                   rows.getColumn(3).getDouble(), rows.getColumn(4).getDouble(),
                   rows.getColumn(5).getDouble(), rows.getColumn(6).getDouble()});
  }
  return out;
}

void ControlTables::set_in_flight(const std::vector<TrialsInFlight>& trials) {
  SQLite::Transaction transaction(*db_, SQLite::TransactionBehavior::IMMEDIATE);
  db_->exec("DELETE FROM in_flight");
  SQLite::Statement insert(
      *db_, "INSERT INTO in_flight VALUES (?, ?, ?, ?, ?, ?, ?, ?, strftime('%Y-%m-%dT%H:%M:%SZ', 'now'))");
  for (const TrialsInFlight& trial : trials) {
    insert.bind(1, static_cast<std::int64_t>(trial.cell));
    insert.bind(2, static_cast<std::int64_t>(trial.first));
    insert.bind(3, static_cast<std::int64_t>(trial.last));
    insert.bind(4, static_cast<std::int64_t>(trial.missing));
    insert.bind(5, static_cast<std::int64_t>(trial.attempts));
    insert.bind(6, trial.host);
    insert.bind(7, static_cast<std::int64_t>(trial.pid));
    insert.bind(8, trial.held_s);
    insert.exec();
    insert.reset();
  }
  transaction.commit();
}

std::vector<TrialsInFlight> ControlTables::in_flight() const {
  std::vector<TrialsInFlight> out;
  if (!has("in_flight")) return out;
  SQLite::Statement rows(*db_,
                         "SELECT cell, first, last, missing, attempts, host, pid, held_s FROM in_flight "
                         "ORDER BY held_s DESC, cell, first");
  while (rows.executeStep()) {
    out.push_back({static_cast<std::uint32_t>(rows.getColumn(0).getInt64()),
                   static_cast<std::uint64_t>(rows.getColumn(1).getInt64()),
                   static_cast<std::uint64_t>(rows.getColumn(2).getInt64()),
                   static_cast<std::uint64_t>(rows.getColumn(3).getInt64()),
                   static_cast<std::uint32_t>(rows.getColumn(4).getInt64()), rows.getColumn(5).getString(),
                   static_cast<std::uint32_t>(rows.getColumn(6).getInt64()), rows.getColumn(7).getDouble()});
  }
  return out;
}

std::string ControlTables::in_flight_reported() const {
  if (!has("in_flight")) return "";
  return db_->execAndGet("SELECT coalesce(max(reported), '') FROM in_flight").getString();
}

}  // namespace fatmc
