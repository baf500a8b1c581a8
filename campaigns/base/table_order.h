// Rows of tables in the order in which they are shown.
#pragma once

#include <vector>

#include "campaigns/base/study.h"

namespace fatmc {

/// Brings the rows of a table together, tables in the order of their first rows.
void group_by_table(std::vector<TableRow>& rows);

}  // namespace fatmc
