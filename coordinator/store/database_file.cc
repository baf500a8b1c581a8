#include "coordinator/store/database_file.h"

#include <SQLiteCpp/SQLiteCpp.h>

#include <filesystem>

#include "coordinator/store/migration.h"
#include "coordinator/store/schema.h"
#include "coordinator/store/spec_difference.h"
#include "proto/wire.h"

namespace fatmc {
namespace {

constexpr int kBusyMs = 5000;
constexpr std::uint32_t kHeartbeatMs = 500;  // of the stored frame, which nobody is sent

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

}  // namespace

// A file without a table: new, or left by a process that died while making it.
bool is_blank(const std::string& path) {
  if (!std::filesystem::exists(path) || std::filesystem::file_size(path) == 0) return true;
  const SQLite::Database db(path, SQLite::OPEN_READWRITE, kBusyMs);
  SQLite::Statement tables(db, "SELECT 1 FROM sqlite_master");
  return !tables.executeStep();
}

void create_campaign(SQLite::Database& db, const CampaignSpec& spec, const std::string& build) {
  db.exec(kTablesSql);
  db.exec(views_sql());
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
  record_event(db, "created", std::to_string(spec.trial_count()) + " trials planned");
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

void resume_campaign(SQLite::Database& db, const StoredCampaign& stored, const CampaignSpec& spec) {
  renew_what_may_change(db, stored, spec);
  SQLite::Statement cell(db, "UPDATE cell SET repetitions = max(repetitions, ?) WHERE name = ?");
  for (const Cell& planned : spec.cells) {
    cell.bind(1, static_cast<std::int64_t>(planned.repetitions));
    cell.bind(2, planned.name);
    cell.exec();
    cell.reset();
  }
  record_event(db, "resumed", std::to_string(spec.trial_count()) + " trials planned");
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

}  // namespace fatmc
