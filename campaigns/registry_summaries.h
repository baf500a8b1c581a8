// The studies whose rows this program can turn into tables: a line each.
//
// A program gets them by linking campaigns_registry_summaries; tests link a registry of their own instead.
#pragma once

#include <string_view>

#include "campaigns/base/study.h"

namespace fatmc {

/// The study of that name, or null.
const SummaryStudy* find_summary_study(std::string_view name);

}  // namespace fatmc
