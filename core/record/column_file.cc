#include "core/record/column_file.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "core/base/check.h"
#include "core/base/text.h"
#include "core/record/column_stream.h"

namespace fatmc {
Result<Columns> read_columns(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in || std::filesystem::is_directory(path))
    return fail(Error{path, 0, "", "cannot be read, name a CSV that exists"});
  Result<ColumnStream> stream = ColumnStream::open(in, path);
  if (!stream) return fail(stream.error());
  std::vector<double> all, row;
  while (true) {
    const Result<bool> more = stream->next(row);
    if (!more) return fail(more.error());
    if (!*more) break;
    all.insert(all.end(), row.begin(), row.end());
  }
  const std::size_t width = stream->names().size();
  Columns columns;
  columns.names = stream->names();
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
      return fail(Error{file, line, "t",
                        "gap: t goes from " + shortest(t(static_cast<Eigen::Index>(i))) + " to " +
                            shortest(t(static_cast<Eigen::Index>(i) + 1)) + " s, steps are " +
                            significant(step, 6) + " s"});
    }
    if (std::abs(steps[i] - step) > 0.01 * step) {
      return fail(Error{file, line, "t",
                        "unequal steps: " + significant(steps[i], 6) + " s among steps of " +
                            significant(step, 6) + " s, resample the record"});
    }
  }
  return static_cast<double>(n - 1) / (t(n - 1) - t(0));
}

}  // namespace fatmc
