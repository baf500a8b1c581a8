// The answer beside the key: a pure function, so that what counts as right can be tested without a flight.
#pragma once

#include <string>
#include <vector>

#include "campaigns/base/trial_row.h"
#include "campaigns/hidden_effect/hidden_draw.h"
#include "core/discrepancy/diagnosis.h"

namespace fatmc::hidden_effect {

/// Sets of ids or names that count as one.
using DeclaredClasses = std::vector<std::vector<std::string>>;

/// Whether the two count as one: equal names, or both in one declared class.
bool count_as_one(const Effect& a, const Effect& b, const DeclaredClasses& classes);

/// The metrics of the key (row_metrics.h) and the first half of the detail.
void write_key(const Drawn& drawn, TrialRow& row);
/// Those of the answer and of both; the second half of the detail.
void write_answer(const Drawn& drawn, const Diagnosis& diagnosis, const DeclaredClasses& classes,
                  TrialRow& row);

}  // namespace fatmc::hidden_effect
