// Which drawn parameter drives which metric of a cell.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/store/campaign_store.h"
#include "core/stats/sensitivity.h"

namespace fatmc::cli {

struct SensitivityRow {
  std::string cell, metric, parameter;
  std::uint64_t n = 0;  ///< trials that have the metric
  std::optional<Estimate> rank, share;
};

struct SensitivityRequest {
  std::string metric;  ///< empty: all of them
  std::string cell;    ///< empty: all of them
  double level = 0.95;
  int resamples = 500;
};

/// Per cell and metric the parameters in falling order of their shares (of rank correlation's magnitude where
/// there are too few trials for shares). "failed", 1 where a trial is not ok, counts as a metric. Metrics
/// that never change are left out. Fails where nothing was drawn, or no such cell or metric is there.
Result<std::vector<SensitivityRow>> sensitivity(const CampaignReader& reader,
                                                const SensitivityRequest& request);

}  // namespace fatmc::cli
