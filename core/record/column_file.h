// Columns of numbers as CSV: a header of names, then a row a sample, shortest decimals that read back bit for bit.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace fatmc {

struct Columns {
  std::vector<std::string> names;
  Eigen::MatrixXd values;  ///< rows x columns
};

/// Reads a CSV. The error names the line and column of a value that is missing or not a finite number, of a row with
/// too few or too many values, and of a name that is empty or stands twice.
Result<Columns> read_columns(const std::string& path);

/// Writes a CSV: into a temporary file beside `path`, renamed when complete, so that no half file is ever seen.
/// Throws std::system_error where the disk refuses.
void write_columns(const std::string& path, const std::vector<std::string>& names,
                   const Eigen::Ref<const Eigen::MatrixXd>& values);

/// Puts `text` at `path` in the same way.
void write_file_atomically(const std::string& path, const std::string& text);

/// Sampling rate from a column t in s; fails on gaps, steps that are unequal by more than 1 %, and times that do not
/// ascend. The first sample is line 2 of `file`.
Result<double> rate_from_time(const Eigen::Ref<const Eigen::VectorXd>& t, const std::string& file);

}  // namespace fatmc
