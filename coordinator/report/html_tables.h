// Tables of published figures beside ours, for a page.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "campaigns/base/study.h"

namespace fatmc {

/// A heading (h3, with the id `prefix`-table-`table name`), the table and its reasons by number, for every table of `rows`.
std::string html_tables(const std::vector<TableRow>& rows, const std::string& prefix);

/// How many rows have which verdict.
struct VerdictCount {
  std::uint64_t exact = 0, match = 0, shape = 0, differs = 0;
  [[nodiscard]] std::uint64_t total() const { return exact + match + shape + differs; }
};
VerdictCount count_verdicts(const std::vector<TableRow>& rows);

}  // namespace fatmc
