// A record as files: RECORD.csv or RECORD.mat with the samples, RECORD.toml with the roles of its columns.
#pragma once

#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/record/record.h"

namespace fatmc {

/// The TOML that belongs to a record when none is named: the same path with .toml for the ending.
std::string record_toml_beside(const std::string& path);

/// Reads and validates a record: a CSV, or by its ending a MAT file (mat_file.h says how its channels are
/// named). `toml_path` empty: the one beside it. Periods and lines that the TOML leaves open stay open (see
/// complete_period).
Result<Record> read_record(const std::string& path, const std::string& toml_path = "");

/// The roles alone, of samples that are still to come under `names` (of the stream `stream`, for errors): a record without
/// samples. What only samples could tell must stand in the TOML: rate_hz, period_samples and excited_lines.
Result<Record> read_stream_roles(const std::string& stream, const std::vector<std::string>& names,
                                 const std::string& toml_path);

/// Finds period and excited lines where the record leaves them open, from the references or, without any,
/// from the inputs; checks a period that was given against them. Fails where the record holds no two whole
/// periods.
Status complete_period(Record& record, const std::string& file);

}  // namespace fatmc
