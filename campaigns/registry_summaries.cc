#include "campaigns/registry_summaries.h"

#include <vector>

#include "campaigns/conditions/summary.h"
#include "campaigns/coverage/summary.h"
#include "campaigns/estimators/summary.h"
#include "campaigns/hidden_effect/summary.h"

namespace fatmc {

const SummaryStudy* find_summary_study(std::string_view name) {
  static const std::vector<SummaryStudy> studies = {conditions::kSummaryStudy, coverage::kSummaryStudy,
                                                    estimators::kSummaryStudy, hidden_effect::kSummaryStudy};
  for (const SummaryStudy& study : studies) {
    if (study.name == name) return &study;
  }
  return nullptr;
}

}  // namespace fatmc
