// A measured experiment: channels sampled at one rate, and what each of them is.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace fatmc {

/// How inputs act between samples.
enum class Hold { zoh, continuous };

struct Record {
  double rate_hz = 0.0;
  std::vector<std::string> names;  ///< of the columns of `samples`
  Eigen::MatrixXd samples;         ///< samples x channels, column-major
  std::vector<int> reference;      ///< columns by role; empty: open loop or unknown
  std::vector<int> input;
  std::vector<int> output;
  std::vector<int> auxiliary;
  int period_samples = 0;          ///< 0: aperiodic or not known yet
  int periods = 0;                 ///< whole periods; 0 as above
  std::vector<int> excited_lines;  ///< harmonics of one period; empty: not known yet
  std::optional<Eigen::MatrixXd> controller_gain;  ///< K of u = K (r - y)
  Hold hold = Hold::zoh;
  std::optional<double> trim_speed_m_s;  ///< V_trim of (3.4)

  [[nodiscard]] int sample_count() const { return static_cast<int>(samples.rows()); }
  /// Column of a name, -1 where there is none.
  [[nodiscard]] int column(const std::string& name) const;
  /// samples x columns.size(), copied.
  [[nodiscard]] Eigen::MatrixXd channels(const std::vector<int>& columns) const;
};

/// Checks what holds for every record: samples, roles, finite values, no dead channel among reference, input and
/// output, whole periods where a period is given (fills in `periods` when it is 0). The error names the channel and
/// the remedy; `file` goes into it.
Status validate(Record& record, const std::string& file);

/// Drops the first `count` periods. At least two must remain.
Status skip_periods(Record& record, int count, const std::string& file);

}  // namespace fatmc
