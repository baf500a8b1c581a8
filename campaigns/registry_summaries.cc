#include "campaigns/registry_summaries.h"

#include <vector>

#include "campaigns/bias/summary.h"
#include "campaigns/coverage/summary.h"
#include "campaigns/stability/summary.h"
#include "campaigns/variance/summary.h"

namespace fatmc {

const SummaryStudy* find_summary_study(std::string_view name) {
  static const std::vector<SummaryStudy> studies = {bias::kSummaryStudy, coverage::kSummaryStudy,
                                                    stability::kSummaryStudy, variance::kSummaryStudy};
  for (const SummaryStudy& study : studies) {
    if (study.name == name) return &study;
  }
  return nullptr;
}

}  // namespace fatmc
