// What is asked of the diagnosis, and whether a figure meets it. Values are judged as they are: that an interval reaches the bar
// is said beside the verdict and does not change it.
#pragma once

#include <optional>
#include <string>

#include "campaigns/base/study.h"
#include "campaigns/hidden_effect/hidden_tier.h"

namespace fatmc::hidden_effect {

enum class Quantity {
  false_alarm,
  false_alarm_bound,  ///< one-sided upper 95 % bound
  detected,
  right,
  right_if_detected,
  right_one_effect,
  class_holds,
  class_size,
  wrong,
  spurious,
  both,
  any,
  unknown,  ///< of what candidates describe: at most; of what none does: at least
  unknown_absorbable,
  error_median,
  error_high,
  covered,
  gap_median,
  gap_high,
};

struct Bar {
  std::optional<double> at_least, at_most;  ///< in the row's unit
};

/// What is asked of that quantity in cells of that role; empty: nothing.
Bar bar_of(Role role, Quantity quantity);

/// Puts the bar beside the row: `published` is the bar (the middle of a range), the verdict "match" where the value meets it, else
/// "differs", and why says which bar it is and whether the interval holds it.
void judge_by_bar(TableRow& row, const Bar& bar);

}  // namespace fatmc::hidden_effect
