#include "coordinator/cli/state_space_file.h"

#include <nlohmann/json.hpp>

#include "core/base/text.h"

namespace fatmc::cli {
namespace {

std::string toml_matrix(const char* name, const Eigen::MatrixXd& matrix) {
  std::string out = std::string(name) + " = [\n";
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    std::vector<std::string> row;
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(shortest(matrix(i, j)));
    out += "  [" + join(row) + "],\n";
  }
  return out + "]\n";
}

std::string toml_names(const char* name, const std::vector<std::string>& names) {
  std::vector<std::string> quoted;
  for (const std::string& text : names) quoted.push_back(nlohmann::json(text).dump());
  return std::string(name) + " = [" + join(quoted) + "]\n";
}

}  // namespace

std::string state_space_toml(const std::string& origin, double rate_hz,
                             const std::vector<std::string>& inputs, const std::vector<std::string>& outputs,
                             const DiscreteModel& model) {
  return "# x[n+1] = A x[n] + B u[n], y[n] = C x[n]; " + origin +
         ".\nkind = \"state_space\"\nrate_hz = " + shortest(rate_hz) + "\n" + toml_names("inputs", inputs) +
         toml_names("outputs", outputs) + toml_matrix("A", model.a) + toml_matrix("B", model.b) +
         toml_matrix("C", model.c);
}

}  // namespace fatmc::cli
