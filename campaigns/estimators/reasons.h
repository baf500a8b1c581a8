// Why figures of section 3.4 differ from print, found by the experiments of campaigns/estimators/README.md.
#pragma once

#include <string_view>

#include "campaigns/base/study.h"

namespace fatmc::estimators {

/// Empty where nothing is known.
std::string_view reason_for(const TableRow& row);

}  // namespace fatmc::estimators
