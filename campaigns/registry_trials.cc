#include "campaigns/registry_trials.h"

#include "campaigns/bias/trial.h"
#include "campaigns/candidates/trial.h"
#include "campaigns/conditions/trial.h"
#include "campaigns/coverage/trial.h"
#include "campaigns/dynamics_change/trial.h"
#include "campaigns/estimators/trial.h"
#include "campaigns/hidden_effect/trial.h"
#include "campaigns/stability/trial.h"
#include "campaigns/variance/trial.h"

namespace fatmc {

const std::vector<TrialStudy>& trial_studies() {
  static const std::vector<TrialStudy> studies = {
      coverage::kTrialStudy,
      estimators::kTrialStudy,
      conditions::kTrialStudy,
      bias::kTrialStudy,
      variance::kTrialStudy,
      stability::kTrialStudy,
      dynamics_change::kTrialStudy,
      candidates::kTrialStudy,
      hidden_effect::kTrialStudy,
  };
  return studies;
}

}  // namespace fatmc
