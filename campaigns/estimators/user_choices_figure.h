// Section 3.5 as a figure: what degree, degrees of freedom and periods do to the fast LPM.
#pragma once

#include <map>
#include <optional>
#include <tuple>

#include "campaigns/base/study.h"
#include "campaigns/estimators/cell_runs.h"

namespace fatmc::estimators {

/// Gathers cells one after another.
class UserChoices {
 public:
  /// The mean error of the cell's fast LPM (indirect), under the degree, degrees of freedom and periods of its spec.
  void add(const CampaignSpec& spec, std::uint32_t index, const CellRuns& cell);
  /// A panel without noise, a panel with; a curve for every degree R and number of periods P. None without a cell.
  [[nodiscard]] std::optional<StudyFigure> figure() const;

 private:
  std::map<std::tuple<bool, int, int>, plot::Line> curves_;  ///< turbulence or none, R, P
};

}  // namespace fatmc::estimators
