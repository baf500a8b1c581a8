// The tables and views of a campaign's database; docs/schema.md describes them for users of SQL.
//
// kTablesSql is version 2. When a version 3 comes, its text moves to migration.cc as it stands here, since a
// migration must not change with what comes after it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "campaigns/base/trial_row.h"

namespace fatmc {

inline constexpr int kApplicationId = 0x46544d43;  ///< "FTMC" in the file's header
inline constexpr int kSchemaVersion = 2;
extern const char* const kTablesSql;
/// Tables beside the results (control_tables.h), made where they are missing: no part of the version.
extern const char* const kControlSql;
/// CREATE VIEW statements for all of kViews; renewed by every migration.
std::string views_sql();

struct ViewDescription {
  std::string_view name;
  std::string_view question;  ///< that it answers
};
inline constexpr std::array kViews = {
    ViewDescription{"cells", "how far is each cell?"},
    ViewDescription{"outcomes", "how did trials end?"},
    ViewDescription{"failures", "which trials failed, and why?"},
    ViewDescription{"trials", "who computed which trial, when, how often was it tried?"},
    ViewDescription{"metrics", "scalars of each trial"},
    ViewDescription{"scalars", "mean, scatter and extremes of each scalar"},
    ViewDescription{"arrays", "arrays of each trial, as blobs"},
    ViewDescription{"elements", "arrays of each trial, a value a row"},
    ViewDescription{"errors", "estimation error, variance and bias of each element of each trial"},
    ViewDescription{"bias", "is the estimate biased, element by element?"},
    ViewDescription{"coverage_of_trials", "which share of a trial's regions holds the truth?"},
    ViewDescription{"coverage", "which share of the regions holds the truth?"},
    ViewDescription{"csl", "how confident are the trials that the loop is stable?"},
    ViewDescription{"provenance", "from which seed, build, drawn parameters, host and time is each row?"},
    ViewDescription{"stops", "after how many trials was each cell precise enough?"},
    ViewDescription{"history", "what happened to this database?"},
};

/// Rows stand in the order of this number: cell in the upper bits, repetition (below 2^40) in the lower.
constexpr std::int64_t trial_id(TrialKey key) {
  return (static_cast<std::int64_t>(key.cell) << 40) | static_cast<std::int64_t>(key.repetition);
}

}  // namespace fatmc
