// What the runs of one cell left behind, gathered for tables and figures.
#pragma once

#include <array>
#include <complex>
#include <string>
#include <vector>

#include "campaigns/base/study.h"
#include "campaigns/estimators/row_arrays.h"

namespace fatmc::estimators {

/// T repeats its experiments 20 times: intervals are for a campaign of that size.
inline constexpr std::size_t kPublishedRepetitions = 20;

struct EstimatorRuns {
  std::vector<std::vector<std::complex<double>>> error;  ///< a run, a line: (Ĝ − G0)/G0
  // One value a run; a run without an estimate counts as 0 lines inside.
  std::vector<double> inside_90, unnoticed;
  // One value a run that has an estimate.
  std::vector<double> relative_error, cost;

  /// (|Ĝ| − |G0|)/|G0| of a run's line, and the same in dB.
  [[nodiscard]] double magnitude_error(std::size_t run, std::size_t line) const;
  [[nodiscard]] double magnitude_error_db(std::size_t run, std::size_t line) const;
  /// Of all runs at a line.
  [[nodiscard]] std::vector<double> magnitude_errors(std::size_t line) const;
  [[nodiscard]] std::vector<double> magnitude_errors_db(std::size_t line) const;
};

struct CellRuns {
  std::string name;                ///< of the cell, or its `label`
  std::vector<std::string> shows;  ///< tables and figures of T that the cell stands for
  std::uint64_t trials = 0, failed = 0;
  std::vector<double> frequency_hz;
  std::array<EstimatorRuns, kEstimators.size()> of;

  [[nodiscard]] bool shown_in(std::string_view what) const;
  /// "ETFE", or "ETFE, nonlinear" where the cell has a label.
  [[nodiscard]] std::string row_name(std::size_t estimator) const;
  [[nodiscard]] std::string failures() const;  ///< a remark, or empty
};

/// One cell; the error is that of its own keys `label` and `shows`. Cells are gathered one at a time: a hundred times T's
/// size is 26 MB a cell.
Result<CellRuns> collect_cell(const CampaignSpec& spec, std::uint32_t index, const RowSource& rows);

}  // namespace fatmc::estimators
