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
};

/// Fails on a file that is no database, or not one of ours, or of another version of the schema.
Result<StoredCampaign> read_campaign(SQLite::Database& db, const std::string& path);

}  // namespace fatmc
