// From a record's files to its estimate: what `fatmc estimate` and the commands that build on it have in common.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "core/base/error.h"
#include "core/ident/frm_estimate.h"
#include "core/ident/lpm_grid.h"
#include "core/ident/matrix_stack.h"
#include "core/record/record.h"

namespace fatmc::cli {

struct EstimateOptions {
  std::string record;  ///< CSV
  std::string meta;    ///< its TOML; empty: beside it
  LpmOptions lpm;
  int skip_periods = 0;
  bool speed_correction = false;
};

struct EstimatedRecord {
  Record record;
  FrmEstimate frm;
  MatrixStack<double> bias;   ///< interpolation bias
  double speed_factor = 1.0;  ///< by which G has been scaled (3.4)
};

/// Adds the options to a command that takes a record.
void add_estimate_options(CLI::App& command, EstimateOptions& options);

/// Reads the record, completes its period and lines, estimates by the fast LPM. Every line holds an estimate; the error
/// names the line that does not, and what would mend it.
Result<EstimatedRecord> estimate_record(const EstimateOptions& options);

/// Two lines for the terminal: what the record holds and how it was estimated.
void print_estimate_head(const EstimateOptions& options, const EstimatedRecord& e);

}  // namespace fatmc::cli
