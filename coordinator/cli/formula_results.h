// What needs no database: tables and figures of formulas, and those of the shipped FAT.
#pragma once

#include <vector>

#include "campaigns/base/study.h"

namespace fatmc::cli {

/// Tables of formulas, then of campaigns/models/fat.toml; without these where that file is not here
/// (another working directory) or has been changed into something else.
std::vector<TableRow> tables_without_database();

/// Figures of formulas, then those of the FAT, likewise.
std::vector<StudyFigure> figures_without_database();

}  // namespace fatmc::cli
