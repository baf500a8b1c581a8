#include "coordinator/store/migration.h"

#include <SQLiteCpp/SQLiteCpp.h>

#include <ctime>

#include "coordinator/store/schema.h"

namespace fatmc {
namespace {

// Version 1 had the same columns in tables without types that are checked, and neither event nor the views of
// estimates. STRICT cannot be added to a table: it is made anew.
void migrate_1_to_2(SQLite::Database& db) {
  constexpr const char* kTables[] = {"campaign", "cell", "name", "trial", "metric", "array"};
  for (const char* table : kTables)
    db.exec(std::string("ALTER TABLE ") + table + " RENAME TO version_1_" + table);
  db.exec(kTablesSql);
  for (const char* table : kTables)
    db.exec(std::string("INSERT INTO ") + table + " SELECT * FROM version_1_" + table);
  for (const char* table : {"array", "metric", "trial", "name", "cell", "campaign"})
    db.exec(std::string("DROP TABLE version_1_") + table);
}

}  // namespace

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

void record_event(SQLite::Database& db, const std::string& what, const std::string& detail) {
  SQLite::Statement event(db, "INSERT INTO event (at, what, detail) VALUES (?, ?, ?)");
  event.bind(1, utc_now());
  event.bind(2, what);
  event.bind(3, detail);
  event.exec();
}

Result<int> schema_version(SQLite::Database& db, const std::string& path) {
  if (db.execAndGet("PRAGMA application_id").getInt() != kApplicationId)
    return fail(Error{path, 0, "", "is a database of something else, name one that fatmc made"});
  const int version = db.execAndGet("PRAGMA user_version").getInt();
  if (version < 1 || version > kSchemaVersion) {
    return fail(Error{path, 0, "",
                      "has schema " + std::to_string(version) + ", this program knows schemas up to " +
                          std::to_string(kSchemaVersion) + "; use the program that made it"});
  }
  return version;
}

int migrate(SQLite::Database& db, int found) {
  if (found == kSchemaVersion) return found;
  SQLite::Transaction transaction(db, SQLite::TransactionBehavior::IMMEDIATE);
  for (const ViewDescription& view : kViews) db.exec("DROP VIEW IF EXISTS " + std::string(view.name));
  if (found < 2) migrate_1_to_2(db);
  db.exec(kControlSql);
  db.exec(views_sql());
  db.exec("PRAGMA user_version = " + std::to_string(kSchemaVersion));
  record_event(db, "migrated",
               "from schema " + std::to_string(found) + " to " + std::to_string(kSchemaVersion));
  transaction.commit();
  return found;
}

}  // namespace fatmc
