// A record as files: RECORD.csv with the samples, RECORD.toml with the roles of its columns.
#pragma once

#include <string>

#include "core/base/error.h"
#include "core/record/record.h"

namespace fatmc {

/// The TOML that belongs to a CSV when none is named: the same path with .toml for the ending.
std::string record_toml_beside(const std::string& csv_path);

/// Reads and validates a record. `toml_path` empty: the one beside the CSV. Periods and lines that the TOML leaves
/// open stay open (see complete_period).
Result<Record> read_record(const std::string& csv_path, const std::string& toml_path = "");

/// Finds period and excited lines where the record leaves them open, from the references or, without any, from the
/// inputs; checks a period that was given against them. Fails where the record holds no two whole periods.
Status complete_period(Record& record, const std::string& file);

}  // namespace fatmc
