// Nominal and robust stability, confidence of lines and of the band (T 5.4-5.6), from the rows of a stability campaign.
#pragma once

#include "campaigns/base/study.h"

namespace fatmc::stability {

/// T's campaign has 50 repetitions: intervals are for a campaign of that size.
inline constexpr int kPublishedRepetitions = 50;

/// Tables "Section 5.4", "Fig. 5-6" to "Fig. 5-10", "Section 5.6".
Result<std::vector<TableRow>> tables(const CampaignSpec& spec, const RowSource& rows);

/// Figs. 5-5 to 5-13 of the first cell.
Result<std::vector<StudyFigure>> figures(const CampaignSpec& spec, const RowSource& rows);

extern const SummaryStudy kSummaryStudy;

}  // namespace fatmc::stability
