// A database opened to leave wishes in it, beside the coordinator that may be writing its results.
#pragma once

#include <memory>
#include <string>

#include "coordinator/store/control_tables.h"
#include "core/base/error.h"

namespace fatmc {

class CampaignControl {
 public:
  /// Fails on what CampaignReader::open fails on, and where the file may not be written.
  static Result<CampaignControl> open(const std::string& path);
  CampaignControl(CampaignControl&&) noexcept;
  ~CampaignControl();

  ControlTables& tables() { return *tables_; }

 private:
  CampaignControl(std::unique_ptr<SQLite::Database> db);
  std::unique_ptr<SQLite::Database> db_;
  std::unique_ptr<ControlTables> tables_;
};

/// Whether a coordinator is writing the database at this moment.
bool has_coordinator(const std::string& path);

}  // namespace fatmc
