// The report: one page for any number of campaigns.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "campaigns/base/study.h"

namespace fatmc {

/// Distribution of one scalar over the trials of a cell.
struct ScalarSummary {
  std::string name;
  std::uint64_t n = 0;  ///< trials that have a finite one
  double mean = 0.0, deviation = 0.0, lowest = 0.0, lower_quartile = 0.0, median = 0.0, upper_quartile = 0.0,
         highest = 0.0;
};

struct CellPage {
  std::string name;
  std::uint64_t planned = 0;
  std::vector<std::pair<std::string, std::uint64_t>> outcomes;  ///< name, trials
  std::vector<std::pair<std::string, std::string>> settings;    ///< what sets the cell apart: path, value
  std::vector<ScalarSummary> scalars;
};

/// Outcomes and scalars of the rows of a cell, scalars in the order of their first appearance.
CellPage summarise_cell(const std::string& name, std::uint64_t planned, std::uint32_t cell,
                        const RowSource& rows);

struct CampaignPage {
  std::string name, title;
  std::vector<std::pair<std::string, std::string>> provenance;  ///< what, value
  std::uint64_t stored = 0, planned = 0;
  std::vector<TableRow> rows;
  std::vector<StudyFigure> figures;
  std::vector<CellPage> cells;
};

/// The page. A campaign without a database (formula tables) has no cells and no provenance.
std::string campaign_page(const std::string& title, const std::vector<CampaignPage>& campaigns);

/// The name of a figure's file and anchor, unique on the page: "coverage-fig-5-4".
std::string figure_name(const CampaignPage& campaign, const StudyFigure& figure);

}  // namespace fatmc
