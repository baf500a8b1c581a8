#include "coordinator/report/tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/base/text.h"

namespace fatmc {
namespace {

constexpr std::size_t kColumns = 11;
using Line = std::array<std::string, kColumns>;
const Line kHeader = {"table", "row", "quantity", "unit", "published", "ours", "low", "high", "n", "verdict", "why"};
constexpr std::array<bool, kColumns> kIsNumber = {false, false, false, false, true, true,
                                                  true,  true,  true,  false, false};

std::string number(double value) { return std::isfinite(value) ? significant(value, 5) : "-"; }

Line line(const TableRow& row) {
  return {row.table,       row.row,          row.quantity,        row.unit,    number(row.published), number(row.value),
          number(row.low), number(row.high), std::to_string(row.n), row.verdict, row.why};
}

// Characters, not bytes, of UTF-8.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string join_line(const Line& cells, const std::array<std::size_t, kColumns>& widths, TableFormat format) {
  const bool markdown = format == TableFormat::markdown;
  std::string out = markdown ? "| " : "";
  for (std::size_t i = 0; i < kColumns; ++i) {
    const std::string padding(widths[i] - width(cells[i]), ' ');
    out += kIsNumber[i] ? padding + cells[i] : cells[i] + padding;
    if (i + 1 < kColumns) out += markdown ? " | " : "  ";
  }
  if (markdown) return out + " |\n";
  out.erase(out.find_last_not_of(' ') + 1);
  return out + "\n";
}

std::string rule(const std::array<std::size_t, kColumns>& widths) {
  std::string out = "|";
  for (std::size_t i = 0; i < kColumns; ++i) {
    out += std::string(widths[i] + 1, '-') + (kIsNumber[i] ? ":" : "-") + "|";
  }
  return out + "\n";
}

std::string format_json(const std::vector<TableRow>& rows) {
  const auto real = [](double value) { return std::isfinite(value) ? nlohmann::ordered_json(value) : nullptr; };
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const TableRow& row : rows) {
    out.push_back({{"table", row.table},
                   {"row", row.row},
                   {"quantity", row.quantity},
                   {"unit", row.unit},
                   {"published", real(row.published)},
                   {"value", real(row.value)},
                   {"low", real(row.low)},
                   {"high", real(row.high)},
                   {"n", row.n},
                   {"verdict", row.verdict},
                   {"why", row.why}});
  }
  return out.dump(2) + "\n";
}

}  // namespace

std::string format_tables(const std::vector<TableRow>& rows, TableFormat format) {
  if (format == TableFormat::json) return format_json(rows);
  std::vector<Line> lines = {kHeader};
  for (const TableRow& row : rows) lines.push_back(line(row));
  std::array<std::size_t, kColumns> widths{};
  for (const Line& cells : lines) {
    for (std::size_t i = 0; i < kColumns; ++i) widths[i] = std::max(widths[i], width(cells[i]));
  }
  std::string out;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    out += join_line(lines[i], widths, format);
    if (i == 0 && format == TableFormat::markdown) out += rule(widths);
  }
  return out;
}

void print_tables(const std::vector<TableRow>& rows, TableFormat format) {
  const std::string text = format_tables(rows, format);
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);
}

}  // namespace fatmc
