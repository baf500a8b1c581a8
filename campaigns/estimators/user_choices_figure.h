// Section 3.5 as a figure: what degree, degrees of freedom and periods do to the fast LPM.
#pragma once

#include <optional>
#include <vector>

#include "campaigns/base/study.h"
#include "campaigns/estimators/cell_runs.h"

namespace fatmc::estimators {

/// A panel without noise, a panel with; a curve for every degree R and number of periods P. None where no cell is shown in
/// "Section 3.5".
std::optional<StudyFigure> user_choices_figure(const CampaignSpec& spec, const std::vector<CellRuns>& cells);

}  // namespace fatmc::estimators
