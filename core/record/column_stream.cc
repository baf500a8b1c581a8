#include "core/record/column_stream.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "core/base/text.h"

namespace fatmc {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '"'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

Result<std::vector<std::string>> read_names(std::string_view line, const std::string& path) {
  std::vector<std::string> names;
  while (true) {
    const std::size_t comma = line.find(',');
    const std::string name(trimmed(line.substr(0, comma)));
    double number = 0.0;
    if (name.empty() || parse_double(name, number)) {
      return fail(Error{path, 1, "",
                        "column " + std::to_string(names.size() + 1) +
                            " has no name, the first line must name the columns"});
    }
    if (std::find(names.begin(), names.end(), name) != names.end()) {
      return fail(Error{path, 1, name, "two columns have this name"});
    }
    names.push_back(name);
    if (comma == std::string_view::npos) return names;
    line.remove_prefix(comma + 1);
  }
}

/// Reads one row into `values`; false where a field is not a finite number (its index in `bad`).
bool read_row(std::string_view line, std::vector<double>& values, std::string_view& bad) {
  values.clear();
  while (true) {
    const std::size_t comma = line.find(',');
    const std::string_view field = line.substr(0, comma);
    double value = 0.0;
    const auto end = std::from_chars(field.data(), field.data() + field.size(), value);
    const bool plain =
        end.ec == std::errc() && end.ptr == field.data() + field.size() && std::isfinite(value);
    if (!plain && !parse_double(field, value)) {
      bad = trimmed(field);
      return false;
    }
    values.push_back(value);
    if (comma == std::string_view::npos) return true;
    line.remove_prefix(comma + 1);
  }
}

}  // namespace

Result<ColumnStream> ColumnStream::open(std::istream& in, std::string name) {
  ColumnStream out(in, std::move(name));
  std::getline(in, out.text_);
  std::string_view header = out.text_;
  if (header.starts_with("\xEF\xBB\xBF")) header.remove_prefix(3);  // byte order mark of some spreadsheets
  Result<std::vector<std::string>> names = read_names(header, out.name_);
  if (!names) return fail(names.error());
  out.names_ = std::move(*names);
  return out;
}

Result<bool> ColumnStream::next(std::vector<double>& row) {
  int blank = 0;  // blank lines are allowed at the end alone
  while (std::getline(*in_, text_)) {
    ++line_;
    if (trimmed(text_).empty()) {
      if (blank == 0) blank = line_;
      continue;
    }
    if (blank != 0) return fail(Error{name_, blank, "", "is empty, records have no gaps"});
    std::string_view bad;
    if (!read_row(text_, row, bad)) {
      const std::string column =
          row.size() < names_.size() ? names_[row.size()] : std::to_string(row.size() + 1);
      return fail(Error{
          name_, line_, column,
          (bad.empty() ? "the value is missing" : "\"" + std::string(bad) + "\" is not a finite number") +
              ", cut or repair the record"});
    }
    if (row.size() != names_.size()) {
      return fail(Error{name_, line_, "",
                        std::to_string(row.size()) + " values where the header names " +
                            std::to_string(names_.size()) + " columns"});
    }
    return true;
  }
  return false;
}

}  // namespace fatmc
