// A cell of any study, ready to run trials as the spec wants them: with the values that the cell sets, with
// drawn parameters, and with what is to be kept.
#pragma once

#include <memory>

#include "campaigns/base/study.h"

namespace fatmc {

/// The spec of one cell alone, as a study sees it: cell 0, the values of its table `set` in their places,
/// nothing that the engine reads for itself. Seeds are those of the whole spec, since they go by names. The
/// error stands at the value that has no place.
Result<CampaignSpec> spec_of_cell(const CampaignSpec& spec, std::uint32_t cell);

/// Every error of the cell's own spec, dispersions at the middle of their laws included, is found here.
/// Afterwards a trial whose drawn parameters cannot be flown has the outcome "infeasible".
Result<std::unique_ptr<PreparedCell>> prepare_trials(const TrialStudy& study, const CampaignSpec& spec,
                                                     std::uint32_t cell);

}  // namespace fatmc
