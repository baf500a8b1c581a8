#include "core/record/column_file.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>
#include <system_error>

#include "core/base/check.h"
#include "core/base/text.h"

namespace fatmc {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '"'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Cuts the first line off `rest`.
std::string_view next_line(std::string_view& rest) {
  const std::size_t end = std::min(rest.find('\n'), rest.size());
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return line;
}

Result<std::vector<std::string>> read_names(std::string_view line, const std::string& path) {
  std::vector<std::string> names;
  while (true) {
    const std::size_t comma = line.find(',');
    const std::string name(trimmed(line.substr(0, comma)));
    double number = 0.0;
    if (name.empty() || parse_double(name, number)) {
      return fail(Error{path, 1, "", "column " + std::to_string(names.size() + 1) +
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
    const bool plain = end.ec == std::errc() && end.ptr == field.data() + field.size() && std::isfinite(value);
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

Result<Columns> read_columns(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in || std::filesystem::is_directory(path)) return fail(Error{path, 0, "", "cannot be read, name a CSV that exists"});
  std::ostringstream buffer;
  buffer << in.rdbuf();
  const std::string text = std::move(buffer).str();
  std::string_view rest = text;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);  // byte order mark of some spreadsheets
  Result<std::vector<std::string>> names = read_names(next_line(rest), path);
  if (!names) return fail(names.error());

  const std::size_t width = names->size();
  std::vector<double> all, row;
  all.reserve(static_cast<std::size_t>(std::count(rest.begin(), rest.end(), '\n') + 1) * width);
  for (int line_number = 2; !rest.empty(); ++line_number) {
    const std::string_view line = next_line(rest);
    if (trimmed(line).empty()) {
      if (trimmed(rest).empty()) break;  // blank lines at the end
      return fail(Error{path, line_number, "", "is empty, records have no gaps"});
    }
    std::string_view bad;
    if (!read_row(line, row, bad)) {
      const std::string name = row.size() < width ? (*names)[row.size()] : std::to_string(row.size() + 1);
      return fail(Error{path, line_number, name,
                        (bad.empty() ? "the value is missing" : "\"" + std::string(bad) + "\" is not a finite number") +
                            ", cut or repair the record"});
    }
    if (row.size() != width) {
      return fail(Error{path, line_number, "", std::to_string(row.size()) + " values where the header names " +
                                                   std::to_string(width) + " columns"});
    }
    all.insert(all.end(), row.begin(), row.end());
  }
  Columns columns;
  columns.names = std::move(*names);
  columns.values = Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
      all.data(), static_cast<Eigen::Index>(all.size() / width), static_cast<Eigen::Index>(width));
  return columns;
}

void write_file_atomically(const std::string& path, const std::string& text) {
  // The rename would put a file in the place of a device, pipe or link.
  std::error_code ignored;
  const auto status = std::filesystem::symlink_status(path, ignored);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw std::system_error(std::make_error_code(std::errc::file_exists), path + " is no plain file");
  }
  const std::string temporary = path + ".part" + std::to_string(::getpid());
  std::FILE* file = std::fopen(temporary.c_str(), "wb");
  if (file == nullptr) throw std::system_error(errno, std::generic_category(), path);
  const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
  const bool closed = std::fclose(file) == 0;
  if (!written || !closed || std::rename(temporary.c_str(), path.c_str()) != 0) {
    const int reason = errno;
    std::remove(temporary.c_str());
    throw std::system_error(reason, std::generic_category(), path);
  }
}

void write_columns(const std::string& path, const std::vector<std::string>& names,
                   const Eigen::Ref<const Eigen::MatrixXd>& values) {
  FATMC_CHECK(static_cast<Eigen::Index>(names.size()) == values.cols(), "a name a column");
  std::string text = join(names, ",") + "\n";
  text.reserve(text.size() + static_cast<std::size_t>(values.size()) * 22);
  char number[32];
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    for (Eigen::Index c = 0; c < values.cols(); ++c) {
      const auto end = std::to_chars(number, number + sizeof number, values(i, c));
      text.append(number, end.ptr);
      text.push_back(c + 1 < values.cols() ? ',' : '\n');
    }
  }
  write_file_atomically(path, text);
}

Result<double> rate_from_time(const Eigen::Ref<const Eigen::VectorXd>& t, const std::string& file) {
  const auto n = t.size();
  if (n < 2) return fail(Error{file, 0, "t", "one sample has no rate"});
  std::vector<double> steps(static_cast<std::size_t>(n - 1));
  for (Eigen::Index i = 0; i + 1 < n; ++i) steps[static_cast<std::size_t>(i)] = t(i + 1) - t(i);
  std::vector<double> sorted = steps;
  std::nth_element(sorted.begin(), sorted.begin() + (n - 1) / 2, sorted.end());
  const double step = sorted[static_cast<std::size_t>((n - 1) / 2)];
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const int line = static_cast<int>(i) + 3;
    if (!(steps[i] > 0.0)) return fail(Error{file, line, "t", "time does not ascend"});
    if (steps[i] > 1.5 * step) {
      return fail(Error{file, line, "t", "gap: t goes from " + shortest(t(static_cast<Eigen::Index>(i))) + " to " +
                                             shortest(t(static_cast<Eigen::Index>(i) + 1)) + " s, steps are " +
                                             significant(step, 6) + " s"});
    }
    if (std::abs(steps[i] - step) > 0.01 * step) {
      return fail(Error{file, line, "t", "unequal steps: " + significant(steps[i], 6) + " s among steps of " +
                                             significant(step, 6) + " s, resample the record"});
    }
  }
  return static_cast<double>(n - 1) / (t(n - 1) - t(0));
}

}  // namespace fatmc
