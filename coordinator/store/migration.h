// Brings a database of an older schema to the present one, step by step, in one transaction.
#pragma once

#include <string>

#include "core/base/error.h"

namespace SQLite {
class Database;
}

namespace fatmc {

/// The version of the schema of a file of ours; an Error when it is of something else, or newer than this
/// program knows.
Result<int> schema_version(SQLite::Database& db, const std::string& path);

/// Migrates where there is something to migrate; returns the version that was found. Nothing has changed when
/// it throws.
int migrate(SQLite::Database& db, int found);

/// Writes a line of the view `history`.
void record_event(SQLite::Database& db, const std::string& what, const std::string& detail);

/// Now, "2026-01-31T12:00:00Z".
std::string utc_now();

}  // namespace fatmc
