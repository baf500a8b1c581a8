// What tables of all formats have in common: number text, headings, reasons by number.
#pragma once

#include <string>
#include <vector>

#include "campaigns/base/study.h"

namespace fatmc {

/// Shares and decibels to a tenth, decibels below 1 to two digits, all else to four; "-" where there is none.
std::string table_number(double value, const std::string& unit);

/// "low to high", or "-".
std::string table_interval(const TableRow& row);

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
