#include "campaigns/registry_trials.h"

namespace fatmc {

const std::vector<TrialStudy>& trial_studies() {
  static const std::vector<TrialStudy> studies = {};
  return studies;
}

}  // namespace fatmc
