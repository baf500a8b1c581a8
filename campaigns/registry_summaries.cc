#include "campaigns/registry_summaries.h"

#include <vector>

#include "campaigns/bias/summary.h"
#include "campaigns/candidates/summary.h"
#include "campaigns/conditions/summary.h"
#include "campaigns/coverage/summary.h"
#include "campaigns/dynamics_change/summary.h"
#include "campaigns/estimators/summary.h"
#include "campaigns/hidden_effect/summary.h"
#include "campaigns/stability/summary.h"
#include "campaigns/variance/summary.h"

namespace fatmc {

const SummaryStudy* find_summary_study(std::string_view name) {
  static const std::vector<SummaryStudy> studies = {
      coverage::kSummaryStudy,
      estimators::kSummaryStudy,
      conditions::kSummaryStudy,
      bias::kSummaryStudy,
      variance::kSummaryStudy,
      stability::kSummaryStudy,
      dynamics_change::kSummaryStudy,
      candidates::kSummaryStudy,
      hidden_effect::kSummaryStudy,
  };
  for (const SummaryStudy& study : studies) {
    if (study.name == name) return &study;
  }
  return nullptr;
}

}  // namespace fatmc
