// A CSV row by row: a header of names, then rows of finite numbers, from a file or as samples arrive on a
// pipe.
#pragma once

#include <istream>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace fatmc {

class ColumnStream {
 public:
  /// Reads the header. `name` stands in errors; the stream must outlive this object. The error names what is
  /// wrong with a name that is empty, a number, or stands twice.
  static Result<ColumnStream> open(std::istream& in, std::string name);

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  /// Line of the file, from 1, of the last row read.
  [[nodiscard]] int line() const { return line_; }
  /// Reads a row of names().size() values into `row`; false at the end. The error names line and column of a
  /// value that is missing or not a finite number, a row of another length, and a blank line that is not at
  /// the end.
  Result<bool> next(std::vector<double>& row);

 private:
  ColumnStream(std::istream& in, std::string name) : in_(&in), name_(std::move(name)) {}

  std::istream* in_;
  std::string name_, text_;
  std::vector<std::string> names_;
  int line_ = 1;
};

}  // namespace fatmc
