#include "coordinator/store/campaign_store.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <map>
#include <optional>

#include "coordinator/store/database_error.h"
#include "coordinator/store/schema.h"
#include "coordinator/store/spec_difference.h"
#include "coordinator/store/stored_campaign.h"
#include "coordinator/store/writer_lock.h"

namespace fatmc {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are stored as little-endian doubles");

constexpr int kBusyMs = 5000;
constexpr std::uint32_t kHeartbeatMs = 500;  // of the stored frame, which nobody is sent

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

// A file without a table: new, or left by a process that died while making it.
bool is_blank(const std::string& path) {
  if (!std::filesystem::exists(path) || std::filesystem::file_size(path) == 0) return true;
  const SQLite::Database db(path, SQLite::OPEN_READWRITE, kBusyMs);
  SQLite::Statement tables(db, "SELECT 1 FROM sqlite_master");
  return !tables.executeStep();
}

void create(SQLite::Database& db, const CampaignSpec& spec, const std::string& build) {
  SQLite::Transaction transaction(db);
  db.exec(kSchemaSql);
  db.exec("PRAGMA application_id = " + std::to_string(kApplicationId));
  db.exec("PRAGMA user_version = " + std::to_string(kSchemaVersion));
  SQLite::Statement campaign(db, "INSERT INTO campaign VALUES (1, ?, ?, ?, ?, ?, ?, ?, ?)");
  const std::string frame = encode(Welcome{spec.identity(), spec.tree, kHeartbeatMs});
  campaign.bind(1, spec.name);
  campaign.bind(2, spec.study);
  campaign.bind(3, static_cast<std::int64_t>(spec.seed));
  campaign.bind(4, spec.identity());
  campaign.bind(5, build);
  campaign.bind(6, canonical_text(spec.tree));
  campaign.bind(7, frame.data(), static_cast<int>(frame.size()));
  campaign.bind(8, utc_now());
  campaign.exec();
  SQLite::Statement cell(db, "INSERT INTO cell VALUES (?, ?, ?)");
  for (std::size_t i = 0; i < spec.cells.size(); ++i) {
    cell.bind(1, static_cast<std::int64_t>(i));
    cell.bind(2, spec.cells[i].name);
    cell.bind(3, static_cast<std::int64_t>(spec.cells[i].repetitions));
    cell.exec();
    cell.reset();
  }
  transaction.commit();
}

Status check_same(const std::string& path, const StoredCampaign& stored, const CampaignSpec& spec,
                  const std::string& build) {
  const std::string remedy = "; repeat what it was made with, or name another file by --db";
  if (stored.spec.seed != spec.seed) {
    return fail(Error{path, 0, "seed",
                      "the database was made with seed " + std::to_string(stored.spec.seed) +
                          ", this run has " + std::to_string(spec.seed) + remedy});
  }
  if (stored.identity != spec.identity()) {
    if (auto difference = first_difference(spec.tree, stored.spec.tree)) {
      difference->message += " (" + path + ")" + remedy;
      return fail(*difference);
    }
    return fail(Error{path, 0, "", "the database was made with another spec" + remedy});
  }
  if (stored.build != build) {
    return fail(Error{path, 0, "build",
                      "the database was made by build " + stored.build.substr(0, 12) + ", this program is " +
                          build.substr(0, 12) +
                          ", whose numbers may differ; finish it with that build, or name "
                          "another file by --db"});
  }
  return {};
}

// The figures to compare with and the precision wanted are no part of the identity and may be changed at any
// time: the run that resumes decides.
void renew_what_may_change(SQLite::Database& db, const StoredCampaign& stored, const CampaignSpec& spec) {
  Tree tree = stored.spec.tree;
  for (const char* key : {"published", "stop", "watch"}) {
    tree.erase(key);
    if (const Tree* own = spec.tree.find(key)) tree.set(key, *own);
  }
  if (canonical_text(tree) == canonical_text(stored.spec.tree)) return;
  const std::string frame = encode(Welcome{stored.identity, tree, kHeartbeatMs});
  SQLite::Statement campaign(db, "UPDATE campaign SET spec_canonical = ?, spec = ?");
  campaign.bind(1, canonical_text(tree));
  campaign.bind(2, frame.data(), static_cast<int>(frame.size()));
  campaign.exec();
}

void resume(SQLite::Database& db, const StoredCampaign& stored, const CampaignSpec& spec) {
  SQLite::Transaction transaction(db);
  renew_what_may_change(db, stored, spec);
  SQLite::Statement cell(db, "UPDATE cell SET repetitions = max(repetitions, ?) WHERE name = ?");
  for (const Cell& planned : spec.cells) {
    cell.bind(1, static_cast<std::int64_t>(planned.repetitions));
    cell.bind(2, planned.name);
    cell.exec();
    cell.reset();
  }
  transaction.commit();
}

Status make_folder(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error) {
    return fail(
        Error{path, 0, "", "its folder cannot be made (" + error.message() + "), name another by --db"});
  }
  if (std::filesystem::is_directory(path, error))
    return fail(Error{path, 0, "", "is a folder, name a file by --db"});
  return {};
}

}  // namespace

struct CampaignStore::Parts {
  WriterLock lock;
  std::string path;
  SQLite::Database db;
  std::optional<SQLite::Statement> insert_trial, find_hash, insert_metric, insert_array, insert_name;
  std::map<std::string, std::int64_t, std::less<>> names;

  Parts(WriterLock held, const std::string& file)
      : lock(std::move(held)),
        path(file),
        db(file, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE | SQLite::OPEN_NOMUTEX, kBusyMs) {}

  // Leaves a single file that may be copied, unless a reader is in it at this moment.
  ~Parts() {
    for (auto* statement : {&insert_trial, &find_hash, &insert_metric, &insert_array, &insert_name})
      statement->reset();
    db.tryExec("PRAGMA journal_mode = DELETE");
  }

  void prepare() {
    insert_trial.emplace(db, "INSERT OR IGNORE INTO trial VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    find_hash.emplace(db, "SELECT content_hash FROM trial WHERE id = ?");
    insert_metric.emplace(db, "INSERT INTO metric VALUES (?, ?, ?, ?)");
    insert_array.emplace(db, "INSERT INTO array VALUES (?, ?, ?, ?)");
    insert_name.emplace(db, "INSERT INTO name (text) VALUES (?)");
    SQLite::Statement all(db, "SELECT id, text FROM name");
    while (all.executeStep()) names.emplace(all.getColumn(1).getString(), all.getColumn(0).getInt64());
  }

  std::int64_t name_id(const std::string& text) {
    const auto known = names.find(text);
    if (known != names.end()) return known->second;
    insert_name->bindNoCopy(1, text);
    insert_name->exec();
    insert_name->reset();
    return names.emplace(text, db.getLastInsertRowid()).first->second;
  }

  StoreOutcome insert(const ComputedRow& computed, const StoreRequest& request, std::uint32_t attempts);
};

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
    find_hash->bind(1, id);
    const bool found = find_hash->executeStep();
    const SQLite::Column hash = find_hash->getColumn(0);
    const bool same = found && hash.getBytes() == static_cast<int>(computed.hash.size()) &&
                      std::memcmp(hash.getBlob(), computed.hash.data(), computed.hash.size()) == 0;
    find_hash->reset();
    return same ? StoreOutcome::duplicate : StoreOutcome::conflict;
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
    parts->db.exec("PRAGMA journal_mode = WAL");
    parts->db.exec("PRAGMA synchronous = FULL");
    if (!stored) create(parts->db, spec, build);
    ControlTables(parts->db).create();
    if (stored) {
      resume(parts->db, *stored, spec);
    }
    parts->prepare();
    return CampaignStore(std::move(parts));
  } catch (const SQLite::Exception& e) {
    if (!is_fault_of_file(e)) throw;
    return fail(database_error(e, path));
  }
}

std::vector<PlanCell> CampaignStore::plan(const CampaignSpec& spec) {
  std::vector<PlanCell> plan;
  for (const Cell& cell : spec.cells) plan.push_back({cell.repetitions, {}, cell.priority});
  SQLite::Statement keys(parts_->db, "SELECT cell, repetition FROM trial ORDER BY id");
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
  SQLite::Transaction transaction(parts_->db, SQLite::TransactionBehavior::IMMEDIATE);
  for (const StoreRequest& request : requests) {
    StoreReport report{request.worker, request.sequence, {}};
    for (std::size_t i = 0; i < request.rows.size(); ++i) {
      report.rows.emplace_back(request.rows[i].row.key,
                               parts_->insert(request.rows[i], request, request.attempts[i]));
    }
    reports.push_back(std::move(report));
  }
  transaction.commit();
  return reports;
}

ControlTables CampaignStore::control() { return ControlTables(parts_->db); }

}  // namespace fatmc
