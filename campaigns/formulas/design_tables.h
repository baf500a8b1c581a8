// Tables 4-1, 5-1 and 5-2: choices of a design and what follows from them.
#pragma once

#include <vector>

#include "campaigns/base/study.h"

namespace fatmc {

/// Lines on each side and degrees of freedom of the two designs (2.127, 2.147), excited lines of Table 5-1. Without
/// scatter: `exact` or `differs`.
std::vector<TableRow> design_tables();

}  // namespace fatmc
