// Figures of the thesis that follow from formulas alone: no campaign, no aircraft, no database.
#pragma once

#include <vector>

#include "campaigns/base/study.h"

namespace fatmc {

/// Figs. 2-17 to 2-20 (interpolation error), 2-34 and 2-35 (intergrid error), 3-6 (frequency resolutions).
std::vector<StudyFigure> formula_figures();

}  // namespace fatmc
