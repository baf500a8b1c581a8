// What the numbers of an estimate mean, in words, for estimate.json.
#pragma once

#include <nlohmann/json.hpp>

#include "coordinator/cli/estimate_record.h"

namespace fatmc::cli {

/// line, dft, transient, window, polynomial or rational, variance and bias, as the method of `e` has them.
nlohmann::ordered_json conventions(const EstimatedRecord& e);

}  // namespace fatmc::cli
