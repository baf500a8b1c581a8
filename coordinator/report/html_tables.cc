#include "coordinator/report/html_tables.h"

#include "coordinator/report/html_page.h"
#include "coordinator/report/table_text.h"

namespace fatmc {
namespace {

std::string one_table(const std::vector<TableRow>& rows, const std::string& prefix) {
  static const std::vector<html::Column> columns = {
      {"row"},     {"quantity"}, {"unit"}, {"published", true}, {"ours", true}, {"95 % interval", true},
      {"n", true}, {"verdict"}};
  Reasons reasons;
  std::vector<std::vector<std::string>> cells;
  const TableRow* above = nullptr;
  for (const TableRow& row : rows) {
    std::string verdict;
    if (!row.verdict.empty())
      verdict =
          "<span class=\"verdict " + html::anchor(row.verdict) + "\">" + html::text(row.verdict) + "</span>";
    if (const int reason = reasons.number_of(row)) verdict += " [" + std::to_string(reason) + "]";
    const bool repeated = above != nullptr && above->row == row.row;
    cells.push_back({repeated ? "" : html::text(row.row), html::text(row.quantity), html::text(row.unit),
                     table_number(row.published, row.unit), table_value(row),
                     table_interval(row), row.n > 0 ? std::to_string(row.n) : "-", verdict});
    above = &row;
  }
  const std::string& name = rows.front().table;
  std::string out = "<h3 id=\"" + prefix + "-table-" + html::anchor(name) + "\">" +
                    html::text(table_heading(name)) + "</h3>\n" + html::table(columns, cells);
  if (reasons.texts().empty()) return out;
  out += "<ol class=\"reasons\">";
  for (const std::string& reason : reasons.texts()) out += "<li>" + html::text(reason) + "</li>\n";
  return out + "</ol>\n";
}

}  // namespace

std::string html_tables(const std::vector<TableRow>& rows, const std::string& prefix) {
  std::string out;
  for (const std::vector<TableRow>& table : tables_of(rows)) out += one_table(table, prefix);
  return out;
}

VerdictCount count_verdicts(const std::vector<TableRow>& rows) {
  VerdictCount out;
  for (const TableRow& row : rows) {
    out.exact += row.verdict == "exact" ? 1 : 0;
    out.match += row.verdict == "match" ? 1 : 0;
    out.shape += row.verdict == "shape" ? 1 : 0;
    out.differs += row.verdict == "differs" ? 1 : 0;
  }
  return out;
}

}  // namespace fatmc
