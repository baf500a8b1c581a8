#include "campaigns/registry_trials.h"

#include "campaigns/bias/trial.h"
#include "campaigns/coverage/trial.h"
#include "campaigns/stability/trial.h"
#include "campaigns/variance/trial.h"

namespace fatmc {

const std::vector<TrialStudy>& trial_studies() {
  static const std::vector<TrialStudy> studies = {bias::kTrialStudy, coverage::kTrialStudy,
                                                  stability::kTrialStudy, variance::kTrialStudy};
  return studies;
}

}  // namespace fatmc
