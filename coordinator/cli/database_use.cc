#include "coordinator/cli/database_use.h"

#include "coordinator/store/database_error.h"

namespace fatmc::cli {

Exit use_database(const std::string& path, const std::function<Exit()>& work) {
  try {
    return work();
  } catch (const SQLite::Exception& e) {
    report(database_error(e, path));
    return is_fault_of_file(e) ? Exit::wrong_use : Exit::failed;
  }
}

}  // namespace fatmc::cli
