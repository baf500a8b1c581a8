#include "campaigns/base/table_order.h"

#include <algorithm>
#include <string>

namespace fatmc {

void group_by_table(std::vector<TableRow>& rows) {
  std::vector<std::string> order;
  for (const TableRow& row : rows) {
    if (std::find(order.begin(), order.end(), row.table) == order.end()) order.push_back(row.table);
  }
  const auto place = [&](const TableRow& row) { return std::find(order.begin(), order.end(), row.table); };
  std::stable_sort(rows.begin(), rows.end(),
                   [&](const TableRow& a, const TableRow& b) { return place(a) < place(b); });
}

}  // namespace fatmc
