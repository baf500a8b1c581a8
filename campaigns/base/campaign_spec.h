// What a campaign is: a study, a seed, and cells that are repeated.
//
//   [campaign]
//   study = "coverage"
//   name = "coverage"            # the default database is results/<name>.db
//   seed = 2018
//
//   [[cell]]
//   name = "nonlinear"
//   repetitions = 50
//   plant = "nonlinear"          # the rest of a cell belongs to the study
//
// All other tables of the file belong to the study, too; it decodes them from `tree`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "campaigns/base/tree.h"
#include "campaigns/base/trial_row.h"
#include "core/base/error.h"
#include "core/random/random_stream.h"

namespace fatmc {

struct Cell {
  std::string name;
  std::uint64_t repetitions = 0;
  Tree tree;  ///< the cell's own table
};

struct CampaignSpec {
  std::string study;
  std::string name;
  std::uint64_t seed = 0;
  std::vector<Cell> cells;
  Tree tree;  ///< the whole file, files that it names (model, ...) included

  [[nodiscard]] std::uint64_t trial_count() const;
  /// The `index`-th trial of the plan: all of the first cell, then the second ...
  [[nodiscard]] TrialKey key(std::uint64_t index) const;
  [[nodiscard]] std::uint64_t index(TrialKey trial_key) const;
  /// Seeds of a trial: by the names of study and cell, so that renumbering cells moves nothing.
  [[nodiscard]] TrialSeed trial_seed(TrialKey trial_key) const;
  /// SHA-256 of everything that can change a result (the numbers of repetitions cannot).
  [[nodiscard]] std::string identity() const;
};

Result<CampaignSpec> decode_campaign(const Tree& tree);

}  // namespace fatmc
