// Tables 3-2 and 3-3, the figures in the text of 3.4.1 and 3.4.2, and an overview of every cell, from the rows of an
// estimator campaign.
#pragma once

#include "campaigns/base/study.h"

namespace fatmc::estimators {

/// Tables "3-2", "3-3", "Section 3.4.1", "Section 3.4.2" of the cells that stand for them, and "Section 3.4" of all cells.
Result<std::vector<TableRow>> tables(const CampaignSpec& spec, const RowSource& rows);

/// Figs. 3-10 to 3-15: of every cell that stands for one of them, the first 20 runs as T shows them; "Section 3.5": error
/// against degrees of freedom of the cells that vary them.
Result<std::vector<StudyFigure>> figures(const CampaignSpec& spec, const RowSource& rows);

extern const SummaryStudy kSummaryStudy;

}  // namespace fatmc::estimators
