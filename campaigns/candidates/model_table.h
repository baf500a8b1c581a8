// All models of a cell, as the rows of its trials give them, and the selection of H 4.2 and 4.3.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "campaigns/base/study.h"
#include "campaigns/candidates/candidates_spec.h"
#include "campaigns/candidates/row_arrays.h"
#include "core/base/error.h"
#include "core/subspace/discrete_model.h"

namespace fatmc::candidates {

struct ModelAnalysisRow {
  std::vector<double> magnitude_db;
  ModalModel model;  ///< discrete, as it was validated
};

struct ModelRow {
  int past = 0, future = 0, order = 0;
  ModelState state = ModelState::ok;
  double agreement = 0.0, rms = 0.0, norm = 0.0;
  double roll_agreement = 0.0, roll_rms = 0.0;  ///< kRollAgreement, kRollRms
  int analysis = -1;                            ///< index into ModelTable::analyses, or -1
  double theil = 0.0;
  std::array<double, kOutputs> output_agreement{};  ///< d1 of each output; 0 where records have other outputs
};

struct ModelTable {
  std::vector<ModelRow> models;
  std::vector<ModelAnalysisRow> analyses;
  std::uint64_t trials = 0, failed_trials = 0;
  double not_identified = 0.0, not_validated = 0.0, not_continuous = 0.0;

  /// Of a model by its index in `models`; null where it was not analysed.
  [[nodiscard]] const ModelAnalysisRow* analysis_of(std::size_t model) const {
    const int at = models[model].analysis;
    return at < 0 ? nullptr : &analyses[static_cast<std::size_t>(at)];
  }
};

/// Fails on rows that an older version of the study left: some array is missing or of another length. The error says which and
/// what to do; the file is the caller's to add.
Result<ModelTable> read_models(std::uint32_t cell, const RowSource& rows);

/// Indices into ModelTable::models, best d1 first. Models that failed are in none.
struct Selected {
  double limit = 0.0;                 ///< of the norm
  std::vector<std::size_t> all;       ///< of the order
  std::vector<std::size_t> best;      ///< `share` of all by d1 alone
  std::vector<std::size_t> accepted;  ///< norm below the limit
  std::vector<std::size_t>
      candidates;  ///< as many as `best`, by d1 among those accepted; fewer where there are not so many
};

Selected select(const ModelTable& table, const Selection& selection);

}  // namespace fatmc::candidates
