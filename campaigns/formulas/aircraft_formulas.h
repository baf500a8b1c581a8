// Tables and figures of the thesis that follow from the aircraft model alone: no campaign, no database.
//
// They belong to the FAT (campaigns/models/fat.toml); another aircraft gives the same quantities of its own, beside figures
// that were not printed for it.
#pragma once

#include <vector>

#include "campaigns/base/aircraft_model.h"
#include "campaigns/base/study.h"

namespace fatmc {

/// Tables A-1, A-2 (modes and zeros) and A-5 (poles of the nominal model, discrete at 0.02 s). A figure is `exact` where
/// ours, rounded or cut off at the printed digits, is the printed one; else `shape` within half a decade, or `differs`.
/// Fails where the aircraft has no level flight; the error is that of Flight::prepare.
Result<std::vector<TableRow>> aircraft_tables(const AircraftModel& model);

/// Figs. 3-2 and A-1 (Bode plots of G0), A-4 (PSD of the gyros), A-5 and A-6 (loop with and without turn coordinator).
Result<std::vector<StudyFigure>> aircraft_figures(const AircraftModel& model);

}  // namespace fatmc
