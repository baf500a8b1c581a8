// One place where what SQLite throws becomes a line that names the file.
#pragma once

#include <functional>
#include <string>

#include "coordinator/cli/command.h"

namespace fatmc::cli {

/// Does `work` on a database. A file that is damaged, no database or not to be opened is wrong use, other
/// failures of SQLite are failures.
Exit use_database(const std::string& path, const std::function<Exit()>& work);

}  // namespace fatmc::cli
