// Tables 4-2 to 4-5 and the bias estimates of section 4.2.3, from the rows of a bias campaign.
#pragma once

#include "campaigns/base/study.h"

namespace fatmc::bias {

/// T's campaign has 50 repetitions: intervals are for a campaign of that size.
inline constexpr int kPublishedRepetitions = 50;

/// Tables "4-2" to "4-5" and "Section 4.2.3".
Result<std::vector<TableRow>> tables(const CampaignSpec& spec, const RowSource& rows);

/// Figs. 4-1 and 4-2 of the first cell.
Result<std::vector<StudyFigure>> figures(const CampaignSpec& spec, const RowSource& rows);

extern const SummaryStudy kSummaryStudy;

}  // namespace fatmc::bias
