#include "campaigns/hidden_effect/bars.h"

#include <cmath>

#include "core/base/text.h"

namespace fatmc::hidden_effect {
namespace {

Bar at_most(double value) { return {std::nullopt, value}; }
Bar at_least(double value) { return {value, std::nullopt}; }

Bar bar_of_null(Quantity quantity) {
  switch (quantity) {
    case Quantity::false_alarm:
      return at_most(1.0);
    case Quantity::false_alarm_bound:
      return at_most(1.5);
    default:
      return {};
  }
}

/// One effect of moderate size.
Bar bar_of_single(Quantity quantity) {
  switch (quantity) {
    case Quantity::right:
      return at_least(97.0);
    case Quantity::right_one_effect:
      return at_least(90.0);
    case Quantity::class_holds:
      return at_least(99.0);
    case Quantity::class_size:
      return at_most(1.2);
    case Quantity::error_median:
      return at_most(2.0);
    case Quantity::error_high:
      return at_most(5.0);
    case Quantity::gap_median:
      return at_most(1.0);
    case Quantity::gap_high:
      return at_most(5.0);
    default:
      return {};
  }
}

/// What holds wherever something known is hidden.
Bar bar_of_known(Quantity quantity) {
  switch (quantity) {
    case Quantity::spurious:
    case Quantity::unknown:
      return at_most(3.0);
    case Quantity::covered:
      return {92.0, 98.0};
    default:
      return {};
  }
}

}  // namespace

Bar bar_of(Role role, Quantity quantity) {
  switch (role) {
    case Role::none:
      return {};
    case Role::null:
      return bar_of_null(quantity);
    case Role::single: {
      const Bar own = bar_of_single(quantity);
      return own.at_least || own.at_most ? own : bar_of_known(quantity);
    }
    case Role::quarter:
      if (quantity == Quantity::detected) return at_least(90.0);
      if (quantity == Quantity::right_if_detected) return at_least(93.0);
      if (quantity == Quantity::wrong) return at_most(3.0);
      return bar_of_known(quantity);
    case Role::two:
      if (quantity == Quantity::both) return at_least(90.0);
      if (quantity == Quantity::any) return at_least(99.0);
      return bar_of_known(quantity);
    case Role::unknown:
      if (quantity == Quantity::unknown) return at_least(95.0);
      if (quantity == Quantity::unknown_absorbable) return at_least(60.0);
      return {};
    case Role::guard:
      if (quantity == Quantity::right) return at_least(85.0);
      return bar_of_known(quantity);
  }
  return {};
}

void judge_by_bar(TableRow& row, const Bar& bar) {
  if (!bar.at_least && !bar.at_most) return;
  const std::string unit = row.unit.empty() ? "" : " " + row.unit;
  const auto say = [&](double value) { return significant(value, 3) + unit; };
  bool met = !std::isnan(row.value), reached = false;
  if (bar.at_least) met = met && row.value >= *bar.at_least;
  if (bar.at_most) met = met && row.value <= *bar.at_most;
  for (const auto& edge : {bar.at_least, bar.at_most})
    reached = reached || (edge && row.low <= *edge && *edge <= row.high);
  if (bar.at_least && bar.at_most) {
    row.published = 0.5 * (*bar.at_least + *bar.at_most);
    row.why = "bar: " + say(*bar.at_least) + " to " + say(*bar.at_most);
  } else {
    row.published = bar.at_least ? *bar.at_least : *bar.at_most;
    row.why = std::string(bar.at_least ? "bar: at least " : "bar: at most ") + say(row.published);
  }
  row.verdict = met ? "match" : "differs";
  if (reached) row.why += "; the interval holds it";
}

}  // namespace fatmc::hidden_effect
