// What a database says about its campaign.
#pragma once

#include <string>

#include "campaigns/base/campaign_spec.h"
#include "core/base/error.h"

namespace SQLite {
class Database;
}

namespace fatmc {

struct StoredCampaign {
  CampaignSpec spec;  ///< repetitions as the table `cell` plans them
  std::string identity;
  std::string build;
  int schema = 0;  ///< version of the file, at most kSchemaVersion
};

/// Fails on a file that is no database, or not one of ours, or of a newer version of the schema. The tables
/// that it reads are the same in all versions.
Result<StoredCampaign> read_campaign(SQLite::Database& db, const std::string& path);

}  // namespace fatmc
