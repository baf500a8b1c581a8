// How a user names a trial: "nonlinear/3" (cell and repetition), or "3" where there is one cell.
#pragma once

#include <string>

#include "campaigns/base/campaign_spec.h"
#include "core/base/error.h"

namespace fatmc::cli {

/// The repetition may lie beyond the plan: a trial is defined all the same.
Result<TrialKey> parse_trial(const CampaignSpec& spec, const std::string& text);

std::string trial_name(const CampaignSpec& spec, TrialKey key);

/// The cell of that name, or an error that lists the names.
Result<std::uint32_t> find_cell(const CampaignSpec& spec, const std::string& name, const std::string& option);

}  // namespace fatmc::cli
