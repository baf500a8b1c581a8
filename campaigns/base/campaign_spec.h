// What a campaign is: a study, a seed, and cells that are repeated.
//
//   [campaign]
//   study = "coverage"
//   name = "coverage"            # the default database is results/<name>.db
//   title = "Coverage (5.3)"     # heading in the report; default: the name
//   seed = 2018
//
//   [[cell]]
//   name = "nonlinear"
//   repetitions = 50
//   priority = 0                 # cells of a higher one are run first
//   disperse = true              # false: without the dispersions of the spec
//   set."estimator.n_e" = 7      # values of this cell alone, by path
//   plant = "nonlinear"          # the rest of a cell belongs to the study
//
// Also of the engine: [[factor]] (cell_grid.h), [[dispersion]] (dispersion.h), [keep] (keep.h), [stop] and
// [watch] (precision_rule.h). All other tables belong to the study; it decodes them from the tree of its cell
// (prepared_trials.h).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "campaigns/base/dispersion.h"
#include "campaigns/base/keep.h"
#include "campaigns/base/precision_rule.h"
#include "campaigns/base/tree.h"
#include "campaigns/base/trial_row.h"
#include "core/base/error.h"
#include "core/random/random_stream.h"

namespace fatmc {

struct Cell {
  std::string name;
  std::uint64_t repetitions = 0;
  std::int64_t priority = 0;
  bool disperse = true;
  Tree tree;  ///< the cell's own table
};

struct CampaignSpec {
  std::string study;
  std::string name, title;
  std::uint64_t seed = 0;
  std::vector<Cell> cells;
  std::vector<Dispersion> dispersions;
  Keep keep;
  std::optional<PrecisionRule> precision;
  Tree tree;  ///< the whole file, files that it names (model, ...) included, factors multiplied out

  [[nodiscard]] std::uint64_t trial_count() const;
  /// The `index`-th trial of the plan: all of the first cell, then the second ...
  [[nodiscard]] TrialKey key(std::uint64_t index) const;
  [[nodiscard]] std::uint64_t index(TrialKey trial_key) const;
  /// Seeds of a trial: by the names of study and cell, so that renumbering cells moves nothing.
  [[nodiscard]] TrialSeed trial_seed(TrialKey trial_key) const;
  /// SHA-256 of everything that can change a result: numbers of repetitions, priorities, the title, `stop`,
  /// `watch` and `published` cannot.
  [[nodiscard]] std::string identity() const;
};

Result<CampaignSpec> decode_campaign(const Tree& tree);

}  // namespace fatmc
