// Variance estimated from one flight against the scatter between flights, and their increase at the borders of the band
// (T section 4.3), from the rows of a variance campaign.
#pragma once

#include "campaigns/base/study.h"

namespace fatmc::variance {

/// T's campaign has 50 repetitions: intervals are for a campaign of that size.
inline constexpr int kPublishedRepetitions = 50;

/// Tables "Section 4.3.2" and "Section 4.3.3".
Result<std::vector<TableRow>> tables(const CampaignSpec& spec, const RowSource& rows);

/// Fig. 4-3 of the first cell.
Result<std::vector<StudyFigure>> figures(const CampaignSpec& spec, const RowSource& rows);

extern const SummaryStudy kSummaryStudy;

}  // namespace fatmc::variance
