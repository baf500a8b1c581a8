// What the models of a cell that may be selected say of modes, levels and resonances, from their rows.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "campaigns/candidates/candidates_spec.h"
#include "campaigns/candidates/model_analysis.h"
#include "campaigns/candidates/model_table.h"

namespace fatmc::candidates {

/// Holds on to `table`.
struct JudgedModels {
  const ModelTable& table;
  std::vector<std::optional<ModelAnalysis>> analyses;  ///< as ModelTable::analyses

  /// None where the model has no continuous counterpart.
  [[nodiscard]] const ModelAnalysis* of(std::size_t model) const {
    const int at = table.models[model].analysis;
    if (at < 0 || !analyses[static_cast<std::size_t>(at)]) return nullptr;
    return &*analyses[static_cast<std::size_t>(at)];
  }
  [[nodiscard]] std::size_t judged(const std::vector<std::size_t>& models) const {
    return static_cast<std::size_t>(
        std::count_if(models.begin(), models.end(), [&](std::size_t i) { return of(i) != nullptr; }));
  }
  /// What to say of those that are not.
  [[nodiscard]] std::string left_out(const std::vector<std::size_t>& models) const {
    const std::size_t without = models.size() - judged(models);
    if (without == 0) return "";
    return std::to_string(without) + " of " + std::to_string(models.size()) +
           " have no continuous model and are not judged";
  }
};

/// Fails where the truth has no continuous counterpart to hold them against.
Result<JudgedModels> judge_models(const ModelTable& table, const Truth& truth);

}  // namespace fatmc::candidates
