// Fig. 5-2: how little turbulence disturbs the inputs, |S_SNRu| of roll, pitch and yaw (T 5.2.1, 5.9). Follows from the
// model alone; no trial is behind it.
#pragma once

#include <array>
#include <vector>

#include "campaigns/base/published_figures.h"
#include "campaigns/base/study.h"

namespace fatmc::coverage {

struct Insensitivity {
  std::vector<double> frequency_hz;
  std::array<std::vector<double>, 3> decibel;  ///< roll, pitch, yaw
};

/// Of the model of the first cell, at the lines that it flies.
Result<Insensitivity> insensitivity_at_lines(const CampaignSpec& spec);
/// Of the same, over two decades, from 0.05 to 5 Hz.
Result<Insensitivity> insensitivity_curve(const CampaignSpec& spec);

/// Rows of table "Fig. 5-2".
Status add_insensitivity_rows(const CampaignSpec& spec, const std::vector<PublishedFigure>& published,
                              std::vector<TableRow>& out);

}  // namespace fatmc::coverage
