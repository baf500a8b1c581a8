// How far the fast LPM can be trusted under conditions that T only mentions: T prints no figures of these, so that the rows
// stand alone.
#pragma once

#include "campaigns/base/study.h"

namespace fatmc::conditions {

/// Repetitions behind the intervals: no campaign is printed, T's other ones have 50.
inline constexpr int kPublishedRepetitions = 50;

/// Table "Conditions", or "Section A.6" where the turn coordinator varies; a block of rows a cell: flights that gave no
/// estimate, error of every element that does not vanish, share of 95 % regions that hold G0, median input SNR, outliers.
Result<std::vector<TableRow>> tables(const CampaignSpec& spec, const RowSource& rows);

/// "Conditions": error against turbulence, a curve for each gain and grade, where turbulence varies; "Section A.6": error of
/// r/ξ_c line by line with and without turn coordinator, where that varies.
Result<std::vector<StudyFigure>> figures(const CampaignSpec& spec, const RowSource& rows);

extern const SummaryStudy kSummaryStudy;

}  // namespace fatmc::conditions
