// The search of a cell: models, laws of chance, signatures and thresholds, a set a level of excitation.
//
// They depend on model and experiment alone, so that all trials of a campaign share them: the processes of a host through files
// (core/discrepancy/basis_cache.h) in FATMC_CACHE, or XDG_CACHE_HOME/fatmc, or HOME/.cache/fatmc; without any of them, or with
// FATMC_CACHE empty, every process makes its own. Every host has a folder of its own there, since the C library's functions may
// differ in the last bit between processors.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "campaigns/hidden_effect/hidden_cell.h"
#include "core/discrepancy/comparison.h"

namespace fatmc::hidden_effect {

struct SearchLevel {
  std::unique_ptr<ModelSimulator> model;
  ComparisonBasis basis;
};

class HiddenSearch {
 public:
  /// Cheap: nothing is flown but once, to see that the model survives the experiment.
  static Result<std::unique_ptr<HiddenSearch>> create(const HiddenCell& cell, const CampaignSpec& spec);

  /// Models of the levels; their bases may not be there yet.
  [[nodiscard]] const ModelSimulator& model(std::size_t level) const { return *levels_[level].model; }
  [[nodiscard]] std::size_t level_count() const { return levels_.size(); }
  /// The levels with their bases, made or read by the first who asks (20 s of processor time a level). The error says why
  /// there are none.
  Result<const std::vector<SearchLevel>*> prepared() const;

 private:
  struct Recipe {
    LpmGrid grid;
    BasisOptions options;
    std::string key;
  };
  std::vector<Recipe> recipes_;
  mutable std::vector<SearchLevel> levels_;
  mutable std::once_flag once_;
  mutable std::optional<Error> error_;
};

/// Cells that differ in what they hide alone share a search.
Result<std::shared_ptr<const HiddenSearch>> search_of(const HiddenCell& cell, const CampaignSpec& spec);

}  // namespace fatmc::hidden_effect
