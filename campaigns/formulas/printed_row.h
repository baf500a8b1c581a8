// Rows whose value is compared with printed digits: no campaign, no scatter, no interval.
#pragma once

#include <string>
#include <vector>

#include "campaigns/base/study.h"
#include "campaigns/formulas/printed.h"

namespace fatmc::formulas {

/// `value` in units of the printed figure's last digit; a printed 0 has units.
double in_last_digits(const Printed& printed, double value);

/// Adds a row: `exact` where `value`, rounded or cut off at the printed digits, is the printed figure; else `differs`, with
/// `otherwise` as the reason.
TableRow& add_printed(std::vector<TableRow>& rows, const std::string& table, const std::string& row,
                      const std::string& quantity, const std::string& unit, const Printed& printed,
                      double value, const std::string& otherwise);

/// `exact` becomes a matter of the bound: value < printed (`below`) or value > printed.
void judge_bound(TableRow& row, bool below, const std::string& otherwise);

/// A row that `differs` by less than half a decade becomes `shape`: same sign and order.
void same_order_is_shape(TableRow& row);

}  // namespace fatmc::formulas
