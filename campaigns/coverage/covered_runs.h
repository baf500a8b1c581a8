// What a pass over the rows of one cell collects for Table 5-5 and Fig. 5-4: one value a run for every figure.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "campaigns/base/study.h"
#include "campaigns/coverage/regions.h"
#include "campaigns/coverage/snr_summary.h"

namespace fatmc::coverage {

/// Abscissae of Fig. 5-4, whose axis ends near 6.
inline constexpr std::array kCdfAbscissae = {0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0};

struct CoveredRuns {
  enum class Scope { element, joint, bonferroni };
  std::uint64_t trials = 0, failed = 0;
  int degrees_of_freedom = 0;
  std::map<std::tuple<Region, std::size_t, Scope>, std::vector<double>> shares;  ///< region, level
  std::map<std::pair<Region, std::size_t>, std::vector<double>> cdf;             ///< region, abscissa
  SnrSummary snr;
};

/// A trial without an estimate has no region that could hold the truth: it counts as outside everywhere.
CoveredRuns covered_runs(std::uint32_t cell, const RowSource& rows);

/// Calls back with the errors of every run that is ok, the sample error of each known.
void for_each_run(std::uint32_t cell, const RowSource& rows,
                  const std::function<void(const TrialRow&, const TrialErrors&)>& visit);

}  // namespace fatmc::coverage
