#include "coordinator/store/campaign_control.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "coordinator/store/campaign_store.h"
#include "coordinator/store/database_error.h"

namespace fatmc {

CampaignControl::CampaignControl(std::unique_ptr<SQLite::Database> db)
    : db_(std::move(db)), tables_(std::make_unique<ControlTables>(*db_)) {}
CampaignControl::CampaignControl(CampaignControl&&) noexcept = default;
CampaignControl::~CampaignControl() = default;

Result<CampaignControl> CampaignControl::open(const std::string& path) {
  if (const Result<CampaignReader> reader = CampaignReader::open(path); !reader) return fail(reader.error());
  try {
    auto db = std::make_unique<SQLite::Database>(path, SQLite::OPEN_READWRITE, 5000);
    CampaignControl out(std::move(db));
    out.tables().create();
    return out;
  } catch (const SQLite::Exception& e) {
    if (!is_fault_of_file(e)) throw;
    return fail(database_error(e, path));
  }
}

// Looks at the lock file of WriterLock without making or removing it, so that a folder may be read-only.
bool has_coordinator(const std::string& path) {
  const int descriptor = ::open((path + ".lock").c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool held = ::flock(descriptor, LOCK_SH | LOCK_NB) != 0;
  ::close(descriptor);
  return held;
}

}  // namespace fatmc
