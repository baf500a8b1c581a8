#include "campaigns/base/campaign_spec.h"
#include "campaigns/registry_trials.h"
#include "core/base/text.h"

namespace fatmc {

const TrialStudy* find_trial_study(std::string_view name) {
  for (const TrialStudy& study : trial_studies()) {
    if (study.name == name) return &study;
  }
  return nullptr;
}

Result<const TrialStudy*> require_trial_study(const CampaignSpec& spec) {
  if (const TrialStudy* study = find_trial_study(spec.study)) return study;
  std::vector<std::string> known;
  for (const TrialStudy& study : trial_studies()) known.push_back(study.name);
  const Tree* table = spec.tree.find("campaign");
  const Tree* entry = table != nullptr ? table->find("study") : nullptr;
  return fail(Error{entry != nullptr ? entry->file : spec.tree.file, entry != nullptr ? entry->line : 0,
                    "campaign.study", "\"" + spec.study + "\" is not known, write one of: " + join(known)});
}

}  // namespace fatmc
