// What SQLite reports, as an error that names the file and what to do.
#pragma once

#include <SQLiteCpp/Exception.h>

#include <string>

#include "core/base/error.h"

namespace fatmc {

/// The file itself is at fault (no database, damaged, not to be opened or written), so that another has to be
/// named; else something failed meanwhile (disk full, ...).
bool is_fault_of_file(const SQLite::Exception& exception);

/// The file is no database, or a damaged one.
bool is_damage(const SQLite::Exception& exception);

/// It may pass by itself or when somebody makes room: disk full, I/O error, locked.
bool is_passing(const SQLite::Exception& exception);

Error database_error(const SQLite::Exception& exception, const std::string& path);

}  // namespace fatmc
