#include "campaigns/registry_trials.h"

#include "campaigns/candidates/trial.h"
#include "campaigns/coverage/trial.h"

namespace fatmc {

const std::vector<TrialStudy>& trial_studies() {
  static const std::vector<TrialStudy> studies = {coverage::kTrialStudy, candidates::kTrialStudy};
  return studies;
}

}  // namespace fatmc
