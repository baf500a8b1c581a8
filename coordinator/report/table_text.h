// What tables of all formats have in common: number text, headings, reasons by number.
#pragma once

#include <string>
#include <vector>

#include "campaigns/base/study.h"

namespace fatmc {

/// Shares and decibels to a tenth, decibels below 1 to two digits, all else to four, and `more` digits; "-" where there is
/// none.
std::string table_number(double value, const std::string& unit, int more = 0);

/// "low to high", or "-". An end that rounds to the other side of the printed figure, or onto it, has as many digits as show on
/// which side it lies: the verdict can be read off the table.
std::string table_interval(const TableRow& row);

/// Of row.value, likewise where the verdict is no match.
std::string table_value(const TableRow& row);

/// "Table 5-5", but "Fig. 5-4" and "Section 5.2.3" speak for themselves.
std::string table_heading(const std::string& table);

/// Rows of one table stand together.
std::vector<std::vector<TableRow>> tables_of(const std::vector<TableRow>& rows);

/// The reasons of a table, each once.
class Reasons {
 public:
  /// Number of the row's reason, from 1; 0 where it has none.
  int number_of(const TableRow& row);
  [[nodiscard]] const std::vector<std::string>& texts() const { return texts_; }

 private:
  std::vector<std::string> texts_;
};

}  // namespace fatmc
