// Tables of published figures beside ours, as text, Markdown or JSON.
#pragma once

#include <string>
#include <vector>

#include "campaigns/base/study.h"

namespace fatmc {

enum class TableFormat { text, markdown, json };

/// JSON: a list of {"table","row","quantity","unit","published","value","low","high","n","verdict","why"},
/// null for NaN. The others: a block a table (rows of one table stand together), columns aligned, "-" for
/// NaN, reasons below.
std::string format_tables(const std::vector<TableRow>& rows, TableFormat format);

/// The same, to standard output.
void print_tables(const std::vector<TableRow>& rows, TableFormat format);

}  // namespace fatmc
