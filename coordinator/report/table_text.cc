#include "coordinator/report/table_text.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/base/text.h"

namespace fatmc {

std::string table_number(double value, const std::string& unit) {
  if (!std::isfinite(value)) return "-";
  if (unit == "dB" && value != 0.0 && std::abs(value) < 1.0) return significant(value, 2);
  return unit == "%" || unit == "dB" ? fixed(value, 1) : significant(value, 4);
}

std::string table_interval(const TableRow& row) {
  if (!std::isfinite(row.low) && !std::isfinite(row.high)) return "-";
  return table_number(row.low, row.unit) + " to " + table_number(row.high, row.unit);
}

std::string table_heading(const std::string& table) {
  const bool bare =
      !table.empty() && std::string_view("0123456789ABC").find(table.front()) != std::string_view::npos;
  return (bare ? "Table " : "") + table;
}

std::vector<std::vector<TableRow>> tables_of(const std::vector<TableRow>& rows) {
  std::vector<std::vector<TableRow>> out;
  for (const TableRow& row : rows) {
    if (out.empty() || out.back().front().table != row.table) out.emplace_back();
    out.back().push_back(row);
  }
  return out;
}

int Reasons::number_of(const TableRow& row) {
  if (row.why.empty()) return 0;
  auto reason = std::find(texts_.begin(), texts_.end(), row.why);
  if (reason == texts_.end()) reason = texts_.insert(texts_.end(), row.why);
  return static_cast<int>(reason - texts_.begin()) + 1;
}

}  // namespace fatmc
