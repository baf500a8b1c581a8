// Table 5-5, the distributions of Fig. 5-4 and the input SNR of section 5.2.3, from the rows of a coverage
// campaign.
#pragma once

#include "campaigns/base/study.h"

namespace fatmc::coverage {

/// T's campaigns have 50 repetitions: intervals are for a campaign of that size.
inline constexpr int kPublishedRepetitions = 50;

/// Tables "5-5", "Fig. 5-4" and "5.2.3", a block of rows a cell; "Fig. 5-2" of the first.
Result<std::vector<TableRow>> tables(const CampaignSpec& spec, const RowSource& rows);

/// Figs. 5-2 to 5-4 of the first cell.
Result<std::vector<StudyFigure>> figures(const CampaignSpec& spec, const RowSource& rows);

extern const SummaryStudy kSummaryStudy;

}  // namespace fatmc::coverage
