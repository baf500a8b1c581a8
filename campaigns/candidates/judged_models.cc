#include "campaigns/candidates/judged_models.h"

#include <algorithm>
#include <utility>

namespace fatmc::candidates {

Result<JudgedModels> judge_models(const ModelTable& table, const Truth& truth) {
  const auto response = truth_response(truth.model, truth.rate_hz);
  if (!response) return fail(response.error());
  JudgedModels out{table, {}};
  for (const ModelAnalysisRow& row : table.analyses) {
    std::optional<ModelAnalysis> found;
    if (const auto bare = continuous_model(row.model.model, 1.0 / truth.rate_hz, Continuation::zoh)) {
      if (const auto analysis = analyse(*bare, row.magnitude_db, *response)) found = *analysis;
    }
    out.analyses.push_back(std::move(found));
  }
  return out;
}

}  // namespace fatmc::candidates
