// Tables and figures of the candidates study from its rows.
#pragma once

#include "campaigns/base/study.h"

namespace fatmc::candidates {

Result<std::vector<TableRow>> tables(const CampaignSpec& spec, const RowSource& rows);
Result<std::vector<StudyFigure>> figures(const CampaignSpec& spec, const RowSource& rows);

extern const SummaryStudy kSummaryStudy;

}  // namespace fatmc::candidates
