#include "coordinator/report/tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "coordinator/report/table_text.h"

namespace fatmc {
namespace {

constexpr std::size_t kColumns = 8;
using Line = std::array<std::string, kColumns>;
const Line kHeader = {"row", "quantity", "unit", "published", "ours", "95 % interval", "n", "verdict"};
constexpr std::array<bool, kColumns> kIsNumber = {false, false, false, true, true, true, true, false};

// Characters, not bytes, of UTF-8.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string join_line(const Line& cells, const std::array<std::size_t, kColumns>& widths,
                      TableFormat format) {
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

// A pipe would begin another cell.
std::string markdown_text(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
  return out;
}

// One table: a heading, its lines, and below them the reasons, each once, by number.
std::string format_table(const std::vector<TableRow>& rows, TableFormat format) {
  const bool markdown = format == TableFormat::markdown;
  std::vector<Line> lines = {kHeader};
  Reasons reasons;
  const TableRow* above = nullptr;
  for (const TableRow& row : rows) {
    std::string verdict = row.verdict;
    if (const int reason = reasons.number_of(row)) {
      verdict += (verdict.empty() ? "[" : " [") + std::to_string(reason) + "]";
    }
    const bool repeated = above != nullptr && above->row == row.row && !markdown;
    const auto plain = [&](const std::string& text) { return markdown ? markdown_text(text) : text; };
    lines.push_back({repeated ? "" : plain(row.row), plain(row.quantity), row.unit,
                     table_number(row.published, row.unit), table_value(row),
                     table_interval(row), row.n > 0 ? std::to_string(row.n) : "-", verdict});
    above = &row;
  }
  std::array<std::size_t, kColumns> widths{};
  for (const Line& cells : lines) {
    for (std::size_t i = 0; i < kColumns; ++i) widths[i] = std::max(widths[i], width(cells[i]));
  }
  std::string out = (markdown ? "### " : "") + table_heading(rows.front().table) + (markdown ? "\n\n" : "\n");
  for (std::size_t i = 0; i < lines.size(); ++i) {
    out += join_line(lines[i], widths, format);
    if (i == 0 && markdown) out += rule(widths);
  }
  if (markdown && !reasons.texts().empty()) out += "\n";
  for (std::size_t i = 0; i < reasons.texts().size(); ++i) {
    out += (markdown ? "" : "  ") + ("[" + std::to_string(i + 1) + "] ") + reasons.texts()[i] +
           (markdown ? "  \n" : "\n");
  }
  return out;
}

std::string format_json(const std::vector<TableRow>& rows) {
  const auto real = [](double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nullptr;
  };
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
  std::string out;
  for (const std::vector<TableRow>& table : tables_of(rows))
    out += (out.empty() ? "" : "\n") + format_table(table, format);
  return out;
}

void print_tables(const std::vector<TableRow>& rows, TableFormat format) {
  const std::string text = format_tables(rows, format);
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);
}

}  // namespace fatmc
