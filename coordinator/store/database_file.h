// Makes the file of a campaign, or finds out whether one that exists is the same campaign's.
#pragma once

#include <string>

#include "campaigns/base/campaign_spec.h"
#include "coordinator/store/stored_campaign.h"
#include "core/base/error.h"

namespace SQLite {
class Database;
}

namespace fatmc {

/// Makes the folder of `path` where there is none; an Error when a file cannot stand there.
Status make_folder(const std::string& path);

/// A file without a table: new, or left by a process that died while making it.
bool is_blank(const std::string& path);

/// Writes tables, views and what describes the campaign; to be called inside a transaction.
void create_campaign(SQLite::Database& db, const CampaignSpec& spec, const std::string& build);

/// Same seed, spec and build? The Error says what differs and what to do.
Status check_same(const std::string& path, const StoredCampaign& stored, const CampaignSpec& spec,
                  const std::string& build);

/// Takes over the run's figures to compare with, and its numbers of repetitions where they are larger.
void resume_campaign(SQLite::Database& db, const StoredCampaign& stored, const CampaignSpec& spec);

}  // namespace fatmc
