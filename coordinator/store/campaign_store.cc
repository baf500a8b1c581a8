#include "coordinator/store/campaign_store.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>

#include "coordinator/store/database_error.h"
#include "coordinator/store/database_file.h"
#include "coordinator/store/migration.h"
#include "coordinator/store/schema.h"
#include "coordinator/store/stored_campaign.h"
#include "coordinator/store/writer_lock.h"

namespace fatmc {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are stored as little-endian doubles");

constexpr int kBusyMs = 5000;

}  // namespace

struct CampaignStore::Parts {
  WriterLock lock;
  std::string path;
  SQLite::Database db;
  std::optional<SQLite::Statement> insert_trial, find_hash, remove_trial, insert_metric, insert_array,
      insert_name, find_name;
  std::map<std::string, std::int64_t, std::less<>> names;
  bool in_transaction = false;  ///< of atomically()

  Parts(WriterLock held, const std::string& file)
      : lock(std::move(held)),
        path(file),
        db(file, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE | SQLite::OPEN_NOMUTEX, kBusyMs) {}

  // Leaves a single file that may be copied, unless a reader is in it at this moment.
  ~Parts() {
    for (auto* statement :
         {&insert_trial, &find_hash, &remove_trial, &insert_metric, &insert_array, &insert_name, &find_name})
      statement->reset();
    db.tryExec("PRAGMA journal_mode = DELETE");
  }

  void prepare() {
    insert_trial.emplace(db, "INSERT OR IGNORE INTO trial VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    find_hash.emplace(db, "SELECT content_hash, outcome FROM trial WHERE id = ?");
    remove_trial.emplace(db, "DELETE FROM trial WHERE id = ?");
    insert_metric.emplace(db, "INSERT INTO metric VALUES (?, ?, ?, ?)");
    insert_array.emplace(db, "INSERT INTO array VALUES (?, ?, ?, ?)");
    insert_name.emplace(db, "INSERT INTO name (text) VALUES (?)");
    find_name.emplace(db, "SELECT id FROM name WHERE text = ?");
  }

  std::int64_t name_id(const std::string& text) {
    const auto known = names.find(text);
    if (known != names.end()) return known->second;
    find_name->bind(1, text);
    const bool found = find_name->executeStep();
    std::int64_t id = found ? find_name->getColumn(0).getInt64() : 0;
    find_name->reset();
    if (!found) {
      insert_name->bind(1, text);
      insert_name->exec();
      insert_name->reset();
      id = db.getLastInsertRowid();
    }
    return names.emplace(text, id).first->second;
  }

  // After a transaction that failed: its names are not in the file, and a statement may stand where it
  // failed.
  void forget() {
    names.clear();
    for (auto* statement :
         {&insert_trial, &find_hash, &remove_trial, &insert_metric, &insert_array, &insert_name, &find_name})
      (*statement)->tryReset();
  }

  StoreOutcome insert(const ComputedRow& computed, const StoreRequest& request, std::uint32_t attempts);
  StoreOutcome compare(const ComputedRow& computed);
};

// What there is to say about a row whose trial is stored already; `stored` when it made room for it.
StoreOutcome CampaignStore::Parts::compare(const ComputedRow& computed) {
  const std::int64_t id = trial_id(computed.row.key);
  find_hash->bind(1, id);
  const bool found = find_hash->executeStep();
  const SQLite::Column hash = find_hash->getColumn(0);
  const bool same = found && hash.getBytes() == static_cast<int>(computed.hash.size()) &&
                    std::memcmp(hash.getBlob(), computed.hash.data(), computed.hash.size()) == 0;
  const bool was_given_up = found && find_hash->getColumn(1).getString() == kQuarantined;
  find_hash->reset();
  // Given up again, or given up while its result was on its way: no conflict of results.
  if (same || (found && computed.row.outcome == kQuarantined)) return StoreOutcome::duplicate;
  if (!was_given_up) return StoreOutcome::conflict;
  remove_trial->bind(1, id);
  remove_trial->exec();
  remove_trial->reset();
  return StoreOutcome::stored;
}

StoreOutcome CampaignStore::Parts::insert(const ComputedRow& computed, const StoreRequest& request,
                                          std::uint32_t attempts) {
  const TrialRow& row = computed.row;
  const std::int64_t id = trial_id(row.key);
  SQLite::Statement& trial = *insert_trial;
  trial.bind(1, id);
  trial.bind(2, static_cast<std::int64_t>(row.key.cell));
  trial.bind(3, static_cast<std::int64_t>(row.key.repetition));
  trial.bindNoCopy(4, row.outcome);
  trial.bindNoCopy(5, row.detail);
  trial.bindNoCopy(6, computed.hash.data(), static_cast<int>(computed.hash.size()));
  trial.bindNoCopy(7, request.host);
  trial.bind(8, static_cast<std::int64_t>(request.pid));
  trial.bind(9, static_cast<std::int64_t>(attempts));
  trial.bind(10, static_cast<std::int64_t>(computed.started_us));
  trial.bind(11, static_cast<std::int64_t>(computed.duration_ns));
  const int inserted = trial.exec();
  trial.reset();
  if (inserted == 0) {
    const StoreOutcome outcome = compare(computed);
    return outcome == StoreOutcome::stored ? insert(computed, request, attempts) : outcome;
  }
  for (std::size_t i = 0; i < row.metrics.size(); ++i) {
    const auto& [name, value] = row.metrics[i];
    insert_metric->bind(1, id);
    insert_metric->bind(2, static_cast<std::int64_t>(i));
    insert_metric->bind(3, name_id(name));
    if (std::isnan(value)) {
      insert_metric->bind(4, &value, sizeof value);  // SQLite would make a NULL of it, and forget its bits
    } else {
      insert_metric->bind(4, value);
    }
    insert_metric->exec();
    insert_metric->reset();
  }
  for (std::size_t i = 0; i < row.arrays.size(); ++i) {
    const auto& [name, values] = row.arrays[i];
    insert_array->bind(1, id);
    insert_array->bind(2, static_cast<std::int64_t>(i));
    insert_array->bind(3, name_id(name));
    // An empty vector may have no address, which SQLite would store as NULL.
    insert_array->bindNoCopy(4, values.empty() ? static_cast<const void*>("") : values.data(),
                             static_cast<int>(values.size() * sizeof(double)));
    insert_array->exec();
    insert_array->reset();
  }
  return StoreOutcome::stored;
}

CampaignStore::CampaignStore(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
CampaignStore::CampaignStore(CampaignStore&&) noexcept = default;
CampaignStore::~CampaignStore() = default;

Result<WriterLock> CampaignStore::lock(const std::string& path) {
  if (Status status = make_folder(path); !status) return fail(status.error());
  return WriterLock::take(path);
}

Result<CampaignStore> CampaignStore::open(const std::string& path, const CampaignSpec& spec,
                                          const std::string& build) {
  Result<WriterLock> held = lock(path);
  if (!held) return fail(held.error());
  return open(std::move(*held), path, spec, build);
}

Result<CampaignStore> CampaignStore::open(WriterLock held, const std::string& path, const CampaignSpec& spec,
                                          const std::string& build) {
  try {
    std::optional<StoredCampaign> stored;
    if (!is_blank(path)) {
      // Read before anything is written, so that a file of another kind stays as it is.
      SQLite::Database db(path, SQLite::OPEN_READWRITE, kBusyMs);
      Result<StoredCampaign> found = read_campaign(db, path);
      if (!found) return fail(found.error());
      if (Status status = check_same(path, *found, spec, build); !status) return fail(status.error());
      stored = std::move(*found);
    }
    auto parts = std::make_unique<Parts>(std::move(held), path);
    // EXTRA while the file goes over to WAL, so that the removal of the rollback journal is on disk, too: one that
    // came back after a power cut would undo the change, and with it all that the WAL holds.
    parts->db.exec("PRAGMA synchronous = EXTRA");
    parts->db.exec("PRAGMA journal_mode = WAL");
    parts->db.exec("PRAGMA synchronous = FULL");
    if (stored) fatmc::migrate(parts->db, stored->schema);
    SQLite::Transaction transaction(parts->db);
    if (stored) {
      resume_campaign(parts->db, *stored, spec);
    } else {
      create_campaign(parts->db, spec, build);
    }
    ControlTables(parts->db).create();
    transaction.commit();
    parts->prepare();
    return CampaignStore(std::move(parts));
  } catch (const SQLite::Exception& e) {
    if (!is_fault_of_file(e)) throw;
    return fail(database_error(e, path));
  }
}

Result<int> CampaignStore::migrate(const std::string& path) {
  if (!std::filesystem::is_regular_file(path))
    return fail(Error{path, 0, "", "no such database, name one that `fatmc run` made"});
  Result<WriterLock> held = lock(path);
  if (!held) return fail(held.error());
  try {
    SQLite::Database db(path, SQLite::OPEN_READWRITE, kBusyMs);
    const Result<StoredCampaign> found = read_campaign(db, path);
    if (!found) return fail(found.error());
    const int from = fatmc::migrate(db, found->schema);
    ControlTables(db).create();
    return from;
  } catch (const SQLite::Exception& e) {
    if (!is_fault_of_file(e)) throw;
    return fail(database_error(e, path));
  }
}

std::vector<PlanCell> CampaignStore::plan(const CampaignSpec& spec, StoredTrials counted) {
  std::vector<PlanCell> plan;
  for (const Cell& cell : spec.cells) {
    plan.push_back(
        {.repetitions = cell.repetitions, .stored = {}, .elsewhere = {}, .priority = cell.priority});
  }
  SQLite::Statement keys(parts_->db,
                         counted == StoredTrials::all
                             ? "SELECT cell, repetition FROM trial ORDER BY id"
                             : "SELECT cell, repetition FROM trial WHERE outcome <> ? ORDER BY id");
  if (counted == StoredTrials::results) keys.bind(1, kQuarantined);
  PlanCell* cell = nullptr;
  std::uint64_t first = 0, last = 0;
  const auto close = [&] {
    if (cell != nullptr) cell->stored.insert(first, last);
  };
  while (keys.executeStep()) {
    PlanCell* own = &plan.at(static_cast<std::size_t>(keys.getColumn(0).getInt64()));
    const auto repetition = static_cast<std::uint64_t>(keys.getColumn(1).getInt64());
    if (own != cell || repetition != last) {
      close();
      cell = own;
      first = repetition;
    }
    last = repetition + 1;
  }
  close();
  return plan;
}

std::vector<StoreReport> CampaignStore::commit(std::span<const StoreRequest> requests) {
  std::vector<StoreReport> reports;
  const auto insert_all = [&] {
    for (const StoreRequest& request : requests) {
      StoreReport report{request.worker, request.sequence, {}};
      for (std::size_t i = 0; i < request.rows.size(); ++i) {
        report.rows.emplace_back(request.rows[i].row.key,
                                 parts_->insert(request.rows[i], request, request.attempts[i]));
      }
      reports.push_back(std::move(report));
    }
    return true;
  };
  try {
    if (parts_->in_transaction) {
      insert_all();
    } else {
      atomically(insert_all);
    }
  } catch (const SQLite::Exception& e) {
    if (!is_passing(e)) throw;
    throw StorageTrouble(e.what());
  }
  return reports;
}

ControlTables CampaignStore::control() { return ControlTables(parts_->db); }

void CampaignStore::atomically(const std::function<bool()>& work) {
  bool done = false;
  try {
    SQLite::Transaction transaction(parts_->db, SQLite::TransactionBehavior::IMMEDIATE);
    parts_->in_transaction = true;
    done = work();
    if (done) transaction.commit();
  } catch (...) {
    parts_->in_transaction = false;
    parts_->forget();
    throw;
  }
  parts_->in_transaction = false;
  if (!done) parts_->forget();
}

}  // namespace fatmc
