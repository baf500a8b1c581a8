#include "campaigns/registry_trials.h"

#include "campaigns/coverage/trial.h"
#include "campaigns/dynamics_change/trial.h"

namespace fatmc {

const std::vector<TrialStudy>& trial_studies() {
  static const std::vector<TrialStudy> studies = {coverage::kTrialStudy, dynamics_change::kTrialStudy};
  return studies;
}

}  // namespace fatmc
