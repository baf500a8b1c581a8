// Fig. 5-16, detection, delay, false alarms and recovery, from the rows of a campaign of changing dynamics.
#pragma once

#include "campaigns/base/study.h"
#include "campaigns/dynamics_change/monitored_runs.h"

namespace fatmc::dynamics_change {

/// Thresholds of the alarms, fixed in the spec before the campaign.
struct AlarmThresholds {
  double csl = 0.5;         ///< alarm below
  double noise_rise = 0.0;  ///< alarm above
};
Result<AlarmThresholds> decode_thresholds(const CampaignSpec& spec);

Result<std::vector<TableRow>> tables(const CampaignSpec& spec, const RowSource& rows);
Result<std::vector<StudyFigure>> figures(const CampaignSpec& spec, const RowSource& rows);

extern const SummaryStudy kSummaryStudy;

}  // namespace fatmc::dynamics_change
