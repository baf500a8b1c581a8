#include "coordinator/input/factor_file.h"

#include <algorithm>
#include <charconv>
#include <complex>
#include <fstream>
#include <string_view>

#include "coordinator/input/csv_row.h"
#include "core/base/text.h"

namespace fatmc {
namespace {

enum class Kind { id, x_real, x_imaginary, radius };

/// What a column means; indices from 0: (input, output) for X, (output, input) for a radius.
struct Column {
  Kind kind = Kind::id;
  Eigen::Index row = 0, column = 0;
};

/// A number from 1 without sign or leading zero, as an index from 0.
bool parse_index(std::string_view text, Eigen::Index& index) {
  int value = 0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || text.front() == '0' || end.ec != std::errc() || end.ptr != text.data() + text.size()) return false;
  index = value - 1;
  return value >= 1 && value <= 1000;
}

bool parse_column(std::string_view name, Column& column) {
  if (name == "id") return true;
  const bool real = name.starts_with("Xre");
  if (real || name.starts_with("Xim")) {
    column.kind = real ? Kind::x_real : Kind::x_imaginary;
    name.remove_prefix(3);
    const std::size_t bar = name.find('_');
    if (bar != std::string_view::npos) {
      return parse_index(name.substr(0, bar), column.row) && parse_index(name.substr(bar + 1), column.column);
    }
    return name.size() == 2 && parse_index(name.substr(0, 1), column.row) &&
           parse_index(name.substr(1), column.column);
  }
  const std::size_t in = name.find("_in");
  if (!name.starts_with("w_out") || in == std::string_view::npos) return false;
  column.kind = Kind::radius;
  return parse_index(name.substr(5, in - 5), column.row) && parse_index(name.substr(in + 3), column.column);
}

struct Header {
  std::vector<std::string> names;
  std::vector<Column> columns;
  Eigen::Index n_in = 0, n_out = 0;
};

std::string name_of(const Column& c, Eigen::Index n_in, Eigen::Index n_out) {
  const std::string row = std::to_string(c.row + 1), column = std::to_string(c.column + 1);
  if (c.kind == Kind::id) return "id";
  if (c.kind == Kind::radius) return "w_out" + row + "_in" + column;
  return (c.kind == Kind::x_real ? "Xre" : "Xim") + row + (n_in > 9 || n_out > 9 ? "_" : "") + column;
}

Result<Header> parse_header(const std::string& line, const std::string& path) {
  Header header;
  header.names = split_csv_row(line);
  for (const std::string& name : header.names) {
    Column column;
    if (!parse_column(name, column)) {
      return fail(Error{path, 1, name, "is not a column of loops; they are id, Xre11, Xim11, .., w_out1_in1, .."});
    }
    const bool radius = column.kind == Kind::radius;
    if (column.kind != Kind::id) {
      header.n_in = std::max(header.n_in, (radius ? column.column : column.row) + 1);
      header.n_out = std::max(header.n_out, (radius ? column.row : column.column) + 1);
    }
    header.columns.push_back(column);
  }
  if (header.n_in == 0) return fail(Error{path, 1, "", "the header names no element of X; it begins id,Xre11,Xim11,.."});
  // Every element exactly once.
  std::vector<Column> wanted{{Kind::id, 0, 0}};
  for (Eigen::Index j = 0; j < header.n_in; ++j) {
    for (Eigen::Index i = 0; i < header.n_out; ++i) {
      wanted.insert(wanted.end(), {{Kind::x_real, j, i}, {Kind::x_imaginary, j, i}, {Kind::radius, i, j}});
    }
  }
  for (const Column& w : wanted) {
    const auto count = std::count_if(header.columns.begin(), header.columns.end(), [&w](const Column& c) {
      return c.kind == w.kind && c.row == w.row && c.column == w.column;
    });
    if (count == 1) continue;
    return fail(Error{path, 1, name_of(w, header.n_in, header.n_out),
                      count == 0 ? "is missing: other columns speak of " + std::to_string(header.n_in) +
                                       " inputs and " + std::to_string(header.n_out) + " outputs"
                                 : "stands there more than once"});
  }
  return header;
}

Result<LoopFactors> parse_row(const Header& header, const std::string& line, const std::string& path, int number) {
  const std::vector<std::string> values = split_csv_row(line);
  if (values.size() != header.names.size()) {
    return fail(Error{path, number, "", "has " + std::to_string(values.size()) + " values for " +
                                            std::to_string(header.names.size()) + " columns"});
  }
  LoopFactors out{"", Eigen::MatrixXcd(header.n_in, header.n_out), Eigen::MatrixXd(header.n_out, header.n_in)};
  for (std::size_t k = 0; k < values.size(); ++k) {
    const Column& c = header.columns[k];
    if (c.kind == Kind::id) {
      out.id = values[k];
      continue;
    }
    double value = 0.0;
    if (!parse_double(values[k], value)) {
      return fail(Error{path, number, header.names[k], "'" + values[k] + "' is not a finite number"});
    }
    if (c.kind == Kind::radius) {
      if (value < 0.0) return fail(Error{path, number, header.names[k], values[k] + " is negative; a radius is not"});
      out.radii(c.row, c.column) = value;
    } else if (c.kind == Kind::x_real) {
      out.x(c.row, c.column).real(value);
    } else {
      out.x(c.row, c.column).imag(value);
    }
  }
  return out;
}

}  // namespace

Result<std::vector<LoopFactors>> read_loop_factors(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  if (!file || !std::getline(file, line)) return fail(Error{path, 0, "", "cannot be read, or is empty"});
  if (line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);  // byte order mark
  const Result<Header> header = parse_header(line, path);
  if (!header) return fail(header.error());
  std::vector<LoopFactors> out;
  for (int number = 2; std::getline(file, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    Result<LoopFactors> row = parse_row(*header, line, path, number);
    if (!row) return fail(row.error());
    out.push_back(std::move(*row));
  }
  if (out.empty()) return fail(Error{path, 2, "", "no row follows the header"});
  return out;
}

}  // namespace fatmc
