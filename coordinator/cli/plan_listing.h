// What a spec would run, as `fatmc run --dry-run` prints it.
#pragma once

#include <string>

#include "campaigns/base/campaign_spec.h"

namespace fatmc::cli {

/// Cells with their numbers of trials and the values that they set, dispersions, stopping, and how much of it
/// the database holds already.
void print_plan(const CampaignSpec& spec, const std::string& database);

}  // namespace fatmc::cli
