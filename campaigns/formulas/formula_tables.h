// Tables of the thesis that follow from formulas alone: no campaign, no database.
#pragma once

#include <vector>

#include "campaigns/base/study.h"

namespace fatmc {

/// Tables 2-1, 2-3, 2-4 and 3-1, then design_tables(). A figure is `exact` where ours, rounded or cut off at the
/// printed digits, is the printed one; `shape` where the printed figure lies between what its rounded inputs allow (low and
/// high are that range); else `differs`. Variants that explain a print are rows of their own.
std::vector<TableRow> formula_tables();

}  // namespace fatmc
