// The tables of a campaign's database; docs/schema.md describes them for users of SQL.
#pragma once

#include <cstdint>

#include "campaigns/base/trial_row.h"

namespace fatmc {

inline constexpr int kApplicationId = 0x46544d43;  ///< "FTMC" in the file's header
inline constexpr int kSchemaVersion = 1;
extern const char* const kSchemaSql;
/// Tables and views beside the results (control_tables.h), made where they are missing: no part of the
/// version.
extern const char* const kControlSql;

/// Rows stand in the order of this number: cell in the upper bits, repetition (below 2^40) in the lower.
constexpr std::int64_t trial_id(TrialKey key) {
  return (static_cast<std::int64_t>(key.cell) << 40) | static_cast<std::int64_t>(key.repetition);
}

}  // namespace fatmc
