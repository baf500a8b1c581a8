// The studies whose trials this program can run: a line each.
//
// A program gets them by linking campaigns_registry_trials; tests link a registry of their own instead.
#pragma once

#include <string_view>
#include <vector>

#include "campaigns/base/study.h"

namespace fatmc {

/// All of them, for messages.
const std::vector<TrialStudy>& trial_studies();

/// The study of that name, or null.
const TrialStudy* find_trial_study(std::string_view name);

/// The study of a spec, or an error at its line that lists the known ones.
Result<const TrialStudy*> require_trial_study(const CampaignSpec& spec);

}  // namespace fatmc
