// Specs as they are shipped, and rows of tables by name.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "campaigns/base/campaign_spec.h"
#include "campaigns/base/study.h"
#include "coordinator/input/toml_file.h"

namespace fatmc::test {

inline CampaignSpec shipped(const std::string& study) {
  return *decode_campaign(*read_toml_resolved("campaigns/" + study + "/spec.toml"));
}

/// Rows of cell 0, in order.
inline RowSource source_of(const std::vector<TrialRow>& rows) {
  return [&rows](std::uint32_t, const std::function<void(const TrialRow&)>& visit) {
    for (const TrialRow& row : rows) visit(row);
  };
}

inline const TableRow& find(const std::vector<TableRow>& rows, const std::string& table,
                            const std::string& row, const std::string& quantity) {
  const auto at = std::find_if(rows.begin(), rows.end(), [&](const TableRow& r) {
    return r.table == table && r.row == row && r.quantity == quantity;
  });
  if (at == rows.end()) throw std::runtime_error("no row " + table + ", " + row + ", " + quantity);
  return *at;
}

/// Sets a value of the spec at a dotted path.
inline void set(CampaignSpec& spec, std::initializer_list<std::string_view> path, Tree value) {
  Tree* here = &spec.tree;
  for (const std::string_view key : path) here = const_cast<Tree*>(here->find(key));
  value.file = here->file;
  value.line = here->line;
  *here = std::move(value);
}

/// Every row with a published figure has a verdict, every verdict but match and exact a reason, and every published figure
/// stands in some row.
inline std::string complaints(const std::vector<TableRow>& rows, std::size_t published) {
  std::string out;
  std::vector<std::string> seen;
  for (const TableRow& row : rows) {
    if (std::isnan(row.published)) continue;
    const std::string name = row.table + ", " + row.row + ", " + row.quantity;
    if (row.verdict.empty()) out += name + ": no verdict\n";
    if ((row.verdict == "shape" || row.verdict == "differs") && row.why.empty())
      out += name + ": no reason\n";
    // Variants of a figure share what stands before the comma.
    const std::string figure = row.table + row.row + row.quantity.substr(0, row.quantity.find(',')) +
                               std::to_string(row.published) + row.unit;
    if (std::find(seen.begin(), seen.end(), figure) == seen.end()) seen.push_back(figure);
  }
  if (seen.size() != published)
    out += std::to_string(seen.size()) + " published figures in the tables, " + std::to_string(published) +
           " in the file\n";
  return out;
}

}  // namespace fatmc::test
