// The rows of one cell, gathered for the table and the figures.
#pragma once

#include <complex>
#include <string>
#include <vector>

#include "campaigns/base/study.h"
#include "campaigns/conditions/row_arrays.h"

namespace fatmc::conditions {

/// What the cell varies, read from its spec.
struct Condition {
  double turbulence_m_s = 0.0;
  double gain = 0.0;  ///< of the roll axis
  std::string grade;
  bool turn_coordinator = true;
};

struct ConditionRuns {
  std::string name;
  Condition condition;
  std::uint64_t trials = 0;
  std::uint64_t failed = 0;  ///< without an estimate
  std::string failure;       ///< detail of the first of them
  std::vector<double> frequency_hz;
  std::array<std::vector<double>, kElements.size()> relative_error;  ///< one value a run with an estimate
  std::array<std::vector<double>, 3> median_snr_db;
  std::vector<double> outliers;
  std::vector<double> inside_95;      ///< one value a run; 0 without an estimate
  std::vector<double> at_rate_limit;  ///< largest share of a servo, a value a run
  /// Mean over runs of (Ĝ − G0)/G0 at every line, and the standard deviation between runs of its magnitude.
  std::array<std::vector<std::complex<double>>, kElements.size()> mean_error;
  std::array<std::vector<double>, kElements.size()> deviation;
};

Result<std::vector<ConditionRuns>> collect(const CampaignSpec& spec, const RowSource& rows);

}  // namespace fatmc::conditions
