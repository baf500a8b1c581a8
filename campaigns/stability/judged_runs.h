// What a pass over the rows of one cell collects.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "campaigns/base/line_runs.h"
#include "campaigns/base/study.h"
#include "campaigns/stability/row_arrays.h"

namespace fatmc::stability {

struct JudgedRuns {
  /// failed: without an estimate. Where any trial has one, the arrays hold them, too, behind the others, as what shows no
  /// stability at all: values infinite, p zero, SNR minus infinity. So every share and quantile is one of all trials.
  std::uint64_t trials = 0, failed = 0;
  std::vector<double> frequency_hz;
  double minimum_snr_db = 0.0;
  std::map<std::string, LineRuns, std::less<>> arrays;

  /// All trials; none where no trial has an estimate, and with it no line is known.
  [[nodiscard]] std::size_t runs() const { return frequency_hz.empty() ? 0 : trials; }
  [[nodiscard]] const LineRuns& array(const std::string& name) const { return arrays.at(name); }
  [[nodiscard]] const LineRuns& value(const Reading& reading, Criterion criterion) const {
    return arrays.at(value_array(reading, criterion));
  }
  [[nodiscard]] const LineRuns& confidence(const Reading& reading, Criterion criterion, Rule rule) const {
    return arrays.at(confidence_array(reading, criterion, rule));
  }
  /// Lines with low_hz <= f <= high_hz, to a tenth of a millihertz.
  [[nodiscard]] std::vector<std::size_t> lines_between(double low_hz, double high_hz) const;
  /// p(B) of every run, the product over its lines (T 2.273); gated: zero where a nominal value is not below 1 or the SNR
  /// of an input too low (T 2.272).
  [[nodiscard]] std::vector<double> band(const Reading& reading, Criterion criterion, Rule rule) const;
  [[nodiscard]] std::vector<double> total_band(const Reading& reading, Criterion criterion, Rule rule) const;
  /// p of every line and run, gated.
  [[nodiscard]] LineRuns total(const Reading& reading, Criterion criterion, Rule rule) const;
};

JudgedRuns judged_runs(std::uint32_t cell, const RowSource& rows);

}  // namespace fatmc::stability
