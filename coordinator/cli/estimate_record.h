// From records' files to their estimate: what `fatmc estimate` and the commands that build on it have in common.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/ident/estimators.h"
#include "core/record/record.h"

namespace fatmc::cli {

struct EstimateOptions {
  std::vector<std::string> records;  ///< CSV; several only where the method takes several experiments
  std::string meta;                  ///< their TOML; empty: beside each
  EstimatorOptions estimator;
  int skip_periods = 0;
  bool speed_correction = false;
  std::vector<double> band_hz;  ///< empty, or lowest and highest frequency of the estimate
};

struct EstimatedRecord {
  EstimationMethod method = EstimationMethod::lpm;
  Record record;  ///< the first one; the others agree with it in all that is reported
  ResponseEstimate response;
  int records = 1;            ///< files that went into it
  double speed_factor = 1.0;  ///< by which G has been scaled (3.4)
};

/// Whether the method could go by harmonics of a period.
inline bool periodic(const EstimatedRecord& e) {
  return e.record.periods >= 2 && !e.record.excited_lines.empty();
}

/// Adds the options, the records apart, to a command that takes records.
void add_estimate_options(CLI::App& command, EstimateOptions& options);

/// Reads the records, completes period and lines where the method needs them, estimates. The error names the line or the
/// property that stands in the way, and what would mend it.
Result<EstimatedRecord> estimate_records(const EstimateOptions& options, EstimationMethod method);

/// Names of a record's columns.
std::vector<std::string> channel_names(const Record& record, const std::vector<int>& columns);

/// "fast LPM, indirect"
std::string estimate_title(const EstimatedRecord& e);

/// Two or three lines for the terminal: what the record holds and how it was estimated.
void print_estimate_head(const EstimateOptions& options, const EstimatedRecord& e);

}  // namespace fatmc::cli
