// Figures of the hidden-effect study.
#pragma once

#include "campaigns/base/study.h"
#include "campaigns/hidden_effect/hidden_results.h"

namespace fatmc::hidden_effect {

/// A confusion matrix a cell with one effect; names and coverage by effect a cell whose effects are candidates; then what those
/// cells share: detection by size, errors of the parameters, the gap before and after.
Result<std::vector<StudyFigure>> figures(const CampaignSpec& spec, const RowSource& rows);

/// Of one cell: answers by kind of effect (ids, whatever the axis or surface), each row the shares of the trials that hid it.
StudyFigure confusion_figure(const CellResults& cell);

}  // namespace fatmc::hidden_effect
