#include "coordinator/store/database_error.h"

#include <sqlite3.h>

namespace fatmc {
namespace {

// Without the extension in the upper bits.
int primary_code(const SQLite::Exception& exception) { return exception.getErrorCode() & 0xff; }

}  // namespace

bool is_damage(const SQLite::Exception& exception) {
  return primary_code(exception) == SQLITE_NOTADB || primary_code(exception) == SQLITE_CORRUPT;
}

bool is_fault_of_file(const SQLite::Exception& exception) {
  if (is_damage(exception)) return true;
  switch (primary_code(exception)) {
    case SQLITE_CANTOPEN:
    case SQLITE_READONLY:
    case SQLITE_PERM:
      return true;
    default:
      return false;
  }
}

bool is_passing(const SQLite::Exception& exception) {
  switch (primary_code(exception)) {
    case SQLITE_FULL:
    case SQLITE_IOERR:
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return true;
    default:
      return false;
  }
}

Error database_error(const SQLite::Exception& exception, const std::string& path) {
  const std::string reason = std::string(" (") + exception.what() + ")";
  switch (primary_code(exception)) {
    case SQLITE_NOTADB:
      return {path, 0, "", "is no database, name one that fatmc made"};
    case SQLITE_CORRUPT:
      return {path, 0, "",
              "is damaged" + reason + ", restore a copy of it or run the campaign into another file"};
    case SQLITE_CANTOPEN:
    case SQLITE_READONLY:
    case SQLITE_PERM:
      return {path, 0, "",
              "cannot be opened" + reason +
                  ", name a file that you may read and write, in a folder that you may write to"};
    default:
      return {path, 0, "", "failed" + reason + "; what was acknowledged is stored"};
  }
}

}  // namespace fatmc
