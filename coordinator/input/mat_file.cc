#include "coordinator/input/mat_file.h"

#include <matio.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <mutex>

#include "core/base/text.h"

namespace fatmc {
namespace {

struct FileCloser {
  void operator()(mat_t* file) const { Mat_Close(file); }
};
struct VariableFreer {
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using File = std::unique_ptr<mat_t, FileCloser>;
using Variable = std::unique_ptr<matvar_t, VariableFreer>;

/// "name(3)" as name and 3, "name" as name and 0.
struct ChannelName {
  std::string variable;
  std::size_t column = 0;
};

ChannelName parse(const std::string& text) {
  const std::size_t open = text.find('(');
  if (open == std::string::npos || open == 0 || text.back() != ')') return {text, 0};
  std::size_t column = 0;
  const char* last = text.data() + text.size() - 1;
  const auto end = std::from_chars(text.data() + open + 1, last, column);
  if (end.ec != std::errc() || end.ptr != last || column == 0) return {text, 0};
  return {text.substr(0, open), column};
}

/// What stands in the way of reading the class as real numbers; empty where nothing does.
std::string obstacle(const matvar_t& v) {
  switch (v.class_type) {
    case MAT_C_DOUBLE:
    case MAT_C_SINGLE:
    case MAT_C_INT8:
    case MAT_C_UINT8:
    case MAT_C_INT16:
    case MAT_C_UINT16:
    case MAT_C_INT32:
    case MAT_C_UINT32:
    case MAT_C_INT64:
    case MAT_C_UINT64:
      break;
    case MAT_C_STRUCT:
      return "is a struct, save the field that is the channel as a variable of its own";
    case MAT_C_CELL:
      return "is a cell array, save the channel as a numeric vector";
    case MAT_C_CHAR:
      return "is text, name a numeric vector or column";
    case MAT_C_SPARSE:
      return "is a sparse matrix, save it with full()";
    default:
      return "is an object or function, name a numeric vector or column";
  }
  if (v.isComplex != 0) return "is complex, a channel is real: save its real and imaginary part apart";
  if (v.rank != 2)
    return "has " + std::to_string(v.rank) + " dimensions, a channel is a vector or the column of a matrix";
  return "";
}

std::string shape(const matvar_t& v) { return std::to_string(v.dims[0]) + " x " + std::to_string(v.dims[1]); }

template <typename T>
void convert(const matvar_t& v, std::size_t first, Eigen::VectorXd& out) {
  const T* data = static_cast<const T*>(v.data) + first;
  for (Eigen::Index i = 0; i < out.size(); ++i) out(i) = static_cast<double>(data[i]);
}

/// `out.size()` values from element `first` on.
void convert_any(const matvar_t& v, std::size_t first, Eigen::VectorXd& out) {
  switch (v.data_type) {
    case MAT_T_DOUBLE:
      return convert<double>(v, first, out);
    case MAT_T_SINGLE:
      return convert<float>(v, first, out);
    case MAT_T_INT8:
      return convert<std::int8_t>(v, first, out);
    case MAT_T_UINT8:
      return convert<std::uint8_t>(v, first, out);
    case MAT_T_INT16:
      return convert<std::int16_t>(v, first, out);
    case MAT_T_UINT16:
      return convert<std::uint16_t>(v, first, out);
    case MAT_T_INT32:
      return convert<std::int32_t>(v, first, out);
    case MAT_T_UINT32:
      return convert<std::uint32_t>(v, first, out);
    case MAT_T_INT64:
      return convert<std::int64_t>(v, first, out);
    case MAT_T_UINT64:
      return convert<std::uint64_t>(v, first, out);
    default:
      out.setConstant(std::numeric_limits<double>::quiet_NaN());  // refused by the record's checks
  }
}

/// Column `column` of `v`, or the vector where it is 0.
Result<Eigen::VectorXd> channel(const matvar_t& v, std::size_t column, const std::string& path,
                                const std::string& name) {
  const auto refuse = [&](std::string why) { return fail(Error{path, 0, name, std::move(why)}); };
  if (std::string why = obstacle(v); !why.empty()) return refuse(why);
  const std::size_t rows = v.dims[0], columns = v.dims[1];
  if (rows == 0 || columns == 0) return refuse("is empty (" + shape(v) + ")");
  if (v.data == nullptr || v.nbytes / rows / columns < static_cast<std::size_t>(v.data_size)) {
    return refuse("cannot be read, the file may be damaged");
  }
  const bool vector = rows == 1 || columns == 1;
  if (column == 0 && !vector) {
    return refuse("is a matrix of " + shape(v) + ", name a column of it, for instance " + v.name + "(1)");
  }
  if (column > columns || (column > 1 && rows == 1)) {
    return refuse("the variable is " + shape(v) +
                  (rows == 1 ? ", name it without an index" : ", there is no such column"));
  }
  Eigen::VectorXd out(static_cast<Eigen::Index>(column == 0 ? rows * columns : rows));
  convert_any(v, column == 0 ? 0 : (column - 1) * rows, out);
  return out;
}

/// matio reads on after an error and says so only in its log: the last such message of this thread, empty for
/// none.
thread_local std::string complaint;

void listen_to_matio() {
  static std::once_flag once;
  std::call_once(once, [] { Mat_LogInitFunc("fatmc", [](int, char* message) { complaint = message; }); });
  complaint.clear();
}

std::vector<std::string> variable_names(mat_t* file) {
  std::vector<std::string> out;
  while (Variable v{Mat_VarReadNextInfo(file)}) {
    if (v->name != nullptr) out.emplace_back(v->name);
  }
  Mat_Rewind(file);
  return out;
}

Status add_channel(mat_t* file, const std::string& path, const std::string& name, MatChannels& out) {
  const ChannelName parsed = parse(name);
  if (std::find(out.variables.begin(), out.variables.end(), parsed.variable) == out.variables.end())
    return {};
  const Variable variable{Mat_VarRead(file, parsed.variable.c_str())};
  if (variable == nullptr || !complaint.empty()) {
    return fail(Error{path, 0, name, "cannot be read, the file may be damaged: " + complaint});
  }
  const Result<Eigen::VectorXd> values = channel(*variable, parsed.column, path, name);
  Columns& columns = out.columns;
  const bool fits = values && (columns.names.empty() || values->size() == columns.values.rows());
  if (!fits && name == "t") return {};  // wanted without need
  if (!values) return fail(values.error());
  if (!fits) {
    const std::string what =
        static_cast<Eigen::Index>(variable->dims[1]) == columns.values.rows() && parsed.column > 0
            ? "runs along the rows (" + shape(*variable) + "), transpose it: channels are columns"
            : "has " + std::to_string(values->size()) + " samples, " + columns.names.front() + " has " +
                  std::to_string(columns.values.rows());
    return fail(Error{path, 0, name, what});
  }
  columns.values.conservativeResize(values->size(), columns.values.cols() + 1);
  columns.values.rightCols(1) = *values;
  columns.names.push_back(name);
  return {};
}

}  // namespace

bool is_mat_file(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return ending == ".mat";
}

Result<MatChannels> read_mat_channels(const std::string& path, const std::vector<std::string>& wanted) {
  listen_to_matio();
  const File file{std::filesystem::is_regular_file(path) ? Mat_Open(path.c_str(), MAT_ACC_RDONLY) : nullptr};
  if (file == nullptr)
    return fail(Error{path, 0, "", "is no MAT file that can be read (versions 4, 5, 7 and 7.3 can)"});
  MatChannels out;
  out.variables = variable_names(file.get());
  if (out.variables.empty())
    return fail(Error{path, 0, "", "holds no variable that can be read, it may be damaged"});
  for (const std::string& name : wanted) {
    const auto& names = out.columns.names;
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    if (Status status = add_channel(file.get(), path, name, out); !status) return fail(status.error());
  }
  return out;
}

}  // namespace fatmc
