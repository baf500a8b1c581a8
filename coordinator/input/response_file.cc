#include "coordinator/input/response_file.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <tuple>

#include "coordinator/input/csv_row.h"
#include "core/base/text.h"

namespace fatmc {
namespace {

constexpr std::array<const char*, 5> kNeeded = {"frequency_hz", "output", "input", "re", "im"};
using Fields = std::array<std::size_t, kNeeded.size()>;
using Elements = std::map<std::tuple<double, std::size_t, std::size_t>, std::complex<double>>;

Result<Fields> find_fields(const std::vector<std::string>& names, const std::string& path) {
  Fields fields{};
  for (std::size_t k = 0; k < kNeeded.size(); ++k) {
    const auto found = std::find(names.begin(), names.end(), kNeeded[k]);
    if (found == names.end()) {
      return fail(Error{path, 1, kNeeded[k],
                        "is missing: a response has the columns line,frequency_hz,output,input,re,im"});
    }
    fields[k] = static_cast<std::size_t>(found - names.begin());
  }
  return fields;
}

std::size_t index_of(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  names.push_back(name);
  return names.size() - 1;
}

Status add_row(const std::vector<std::string>& row, const Fields& fields, const std::string& path, int number,
               ResponseTable& table, Elements& elements) {
  std::array<double, 3> values{};  // frequency_hz, re, im
  constexpr std::array<std::size_t, 3> kNumbers = {0, 3, 4};
  for (std::size_t k = 0; k < kNumbers.size(); ++k) {
    const std::string& text = row[fields[kNumbers[k]]];
    if (!parse_double(text, values[k])) {
      return fail(Error{path, number, kNeeded[kNumbers[k]], "'" + text + "' is not a finite number"});
    }
  }
  const std::size_t i = index_of(table.outputs, row[fields[1]]), j = index_of(table.inputs, row[fields[2]]);
  if (!elements.emplace(std::tuple(values[0], i, j), std::complex<double>(values[1], values[2])).second) {
    return fail(Error{path, number, row[fields[1]] + "/" + row[fields[2]],
                      "stands there twice at " + shortest(values[0]) + " Hz"});
  }
  return {};
}

}  // namespace

Result<ResponseTable> read_response_table(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  if (!file || std::filesystem::is_directory(path) || !std::getline(file, line)) {
    return fail(Error{path, 0, "", "cannot be read, or is empty"});
  }
  const std::vector<std::string> names = split_csv_row(line);
  const Result<Fields> fields = find_fields(names, path);
  if (!fields) return fail(fields.error());
  ResponseTable table;
  Elements elements;
  for (int number = 2; std::getline(file, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const std::vector<std::string> row = split_csv_row(line);
    if (row.size() != names.size()) {
      return fail(Error{
          path, number, "",
          "has " + std::to_string(row.size()) + " values for " + std::to_string(names.size()) + " columns"});
    }
    if (Status status = add_row(row, *fields, path, number, table, elements); !status)
      return fail(status.error());
  }
  if (elements.empty()) return fail(Error{path, 2, "", "no row follows the header"});
  for (const auto& [at, value] : elements) {
    if (table.frequency_hz.empty() || table.frequency_hz.back() != std::get<0>(at)) {
      table.frequency_hz.push_back(std::get<0>(at));
    }
  }
  table.response.resize(static_cast<int>(table.outputs.size()), static_cast<int>(table.inputs.size()),
                        static_cast<int>(table.frequency_hz.size()));
  for (int k = 0; k < table.response.count(); ++k) {
    const double f = table.frequency_hz[static_cast<std::size_t>(k)];
    for (std::size_t i = 0; i < table.outputs.size(); ++i) {
      for (std::size_t j = 0; j < table.inputs.size(); ++j) {
        const auto found = elements.find(std::tuple(f, i, j));
        if (found == elements.end()) {
          return fail(
              Error{path, 0, table.outputs[i] + "/" + table.inputs[j],
                    "is missing at " + shortest(f) + " Hz: every element is needed at every frequency"});
        }
        table.response[k](static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = found->second;
      }
    }
  }
  return table;
}

Result<MatrixStack<std::complex<double>>> matching_response(const ResponseTable& table,
                                                            const std::vector<std::string>& outputs,
                                                            const std::vector<std::string>& inputs,
                                                            const std::string& path) {
  const auto pick = [&](const std::vector<std::string>& wanted, const std::vector<std::string>& names,
                        const char* role) -> Result<std::vector<Eigen::Index>> {
    std::vector<Eigen::Index> at;
    for (const std::string& name : wanted) {
      const auto found = std::find(names.begin(), names.end(), name);
      if (found == names.end()) {
        return fail(Error{path, 0, role,
                          "the response has no " + std::string(role) + " \"" + name +
                              "\" of the record, it has " + join(names)});
      }
      at.push_back(found - names.begin());
    }
    return at;
  };
  const auto rows = pick(outputs, table.outputs, "output");
  if (!rows) return fail(rows.error());
  const auto columns = pick(inputs, table.inputs, "input");
  if (!columns) return fail(columns.error());
  MatrixStack<std::complex<double>> out(static_cast<int>(rows->size()), static_cast<int>(columns->size()),
                                        table.response.count());
  for (int k = 0; k < out.count(); ++k) out[k] = table.response[k](*rows, *columns);
  return out;
}

}  // namespace fatmc
