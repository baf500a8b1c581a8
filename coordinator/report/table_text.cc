#include "coordinator/report/table_text.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/base/text.h"

namespace fatmc {

namespace {

int side(double of, double reference) { return of < reference ? -1 : of > reference ? 1 : 0; }

// Of `value`, whose side of the printed figure decides.
std::string decisive_number(double value, const TableRow& row) {
  std::string text = table_number(value, row.unit);
  if (row.verdict.empty() || !std::isfinite(value) || !std::isfinite(row.published)) return text;
  double shown = 0.0, printed = 0.0;  // both as the reader sees them
  if (!parse_double(table_number(row.published, row.unit), printed)) return text;
  for (int more = 1; more <= 6; ++more) {
    if (!parse_double(text, shown) || side(shown, printed) == side(value, row.published)) return text;
    text = table_number(value, row.unit, more);
  }
  return text;
}

}  // namespace

std::string table_number(double value, const std::string& unit, int more) {
  if (!std::isfinite(value)) return "-";
  if (unit == "dB" && value != 0.0 && std::abs(value) < 1.0) return significant(value, 2 + more);
  return unit == "%" || unit == "dB" ? fixed(value, 1 + more) : significant(value, 4 + more);
}

std::string table_interval(const TableRow& row) {
  if (!std::isfinite(row.low) && !std::isfinite(row.high)) return "-";
  return decisive_number(row.low, row) + " to " + decisive_number(row.high, row);
}

std::string table_value(const TableRow& row) {
  const bool agrees = row.verdict.empty() || row.verdict == "match" || row.verdict == "exact";
  return agrees ? table_number(row.value, row.unit) : decisive_number(row.value, row);
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
