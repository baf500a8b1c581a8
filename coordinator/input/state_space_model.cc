#include "coordinator/input/state_space_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "campaigns/base/decoder.h"
#include "core/base/text.h"
#include "core/robust/held_sampling.h"

namespace fatmc {
namespace {

/// Rows of an entry that should be a matrix, and columns of its first row; zero where it is none.
std::pair<std::size_t, std::size_t> shape(const Tree& tree, const char* key) {
  const Tree* entry = tree.find(key);
  const Tree::Array* rows = entry != nullptr ? entry->array() : nullptr;
  if (rows == nullptr || rows->items.empty()) return {0, 0};
  const Tree::Array* first = rows->items.front().array();
  return {rows->items.size(), first != nullptr ? first->items.size() : 0};
}

Eigen::MatrixXd read_matrix(Decoder& table, const char* key, std::size_t rows, std::size_t columns) {
  const std::vector<std::vector<double>> values = table.matrix(key, rows, columns);
  Eigen::MatrixXd out =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
  for (std::size_t i = 0; i < std::min(rows, values.size()); ++i) {
    for (std::size_t j = 0; j < std::min(columns, values[i].size()); ++j) {
      out(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = values[i][j];
    }
  }
  return out;
}

std::vector<std::string> read_names(Decoder& table, const char* key, std::size_t count,
                                    const std::vector<std::string>& record) {
  if (!table.has(key) && record.size() != count) {
    table.reject(key, "is needed: the model has " + std::to_string(count) + ", the record " +
                          std::to_string(record.size()));
  }
  std::vector<std::string> names = table.texts(key, record);
  if (names.size() != count) {
    table.reject(
        key, "holds " + std::to_string(names.size()) + " names for " + std::to_string(count) + " channels");
  }
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (std::count(names.begin(), names.end(), names[k]) > 1)
      table.reject(key, "names \"" + names[k] + "\" twice");
  }
  return names;
}

/// The model's rate has to be the record's.
void check_rate(Decoder& table, double record_rate_hz) {
  const bool rate_given = table.has("rate_hz"), time_given = table.has("sample_time_s");
  const double rate_hz = rate_given ? table.real("rate_hz", {.low = 1e-9, .high = 1e9}) : 0.0;
  const double time_s = time_given ? table.real("sample_time_s", {.low = 1e-9, .high = 1e9}) : 0.0;
  if (rate_given == time_given) {
    table.reject("rate_hz", "give either rate_hz or sample_time_s");
  } else if (!table.error()) {
    const double rate = rate_given ? rate_hz : 1.0 / time_s;
    if (std::abs(rate / record_rate_hz - 1.0) > 1e-6) {
      table.reject(rate_given ? "rate_hz" : "sample_time_s",
                   "the model is sampled at " + significant(rate, 8) + " Hz, the record at " +
                       shortest(record_rate_hz) + " Hz: sample the model at the record's rate");
    }
  }
}

/// A continuous model sampled as the record is.
void sample(Decoder& table, const RecordChannels& record, SampledModel& model) {
  if (table.has("rate_hz") || table.has("sample_time_s"))
    return table.reject("rate_hz", "belongs to a sampled model, this one is continuous: leave it out");
  if (record.hold != Hold::zoh) {
    return table.reject(
        "time",
        "a continuous model is sampled with held inputs, the record's hold is \"continuous\": give the "
        "model's response as kind = \"frf\"");
  }
  if (table.error()) return;
  const auto sampled = sample_held(model, 1.0 / record.rate_hz);
  if (!sampled) return table.reject("A", "cannot be sampled: its exponential over one sample is not finite");
  model = *sampled;
}

}  // namespace

Result<NamedModel> decode_state_space(const Tree& tree, const RecordChannels& record) {
  Decoder table(tree, "");
  table.choice("kind", {"state_space"});
  table.text("name", "");
  const bool continuous = table.choice("time", {"discrete", "continuous"}, "discrete") == "continuous";
  if (!continuous) check_rate(table, record.rate_hz);
  const std::size_t states = shape(tree, "A").first, n_in = shape(tree, "B").second,
                    n_out = shape(tree, "C").first;
  NamedModel out;
  out.model.a = read_matrix(table, "A", states, states);
  out.model.b = read_matrix(table, "B", states, n_in);
  out.model.c = read_matrix(table, "C", n_out, states);
  out.model.d = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(n_out), static_cast<Eigen::Index>(n_in));
  if (table.has("D")) out.model.d = read_matrix(table, "D", n_out, n_in);
  if (continuous) sample(table, record, out.model);
  if (!table.error()) {
    out.inputs = read_names(table, "inputs", n_in, record.inputs);
    out.outputs = read_names(table, "outputs", n_out, record.outputs);
  }
  if (Status status = table.finish(); !status) return fail(status.error());
  return out;
}

Result<std::vector<Eigen::Index>> channel_places(const std::vector<std::string>& wanted,
                                                 const std::vector<std::string>& names,
                                                 const std::string& role, const std::string& path) {
  std::vector<Eigen::Index> out;
  for (const std::string& name : wanted) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      return fail(Error{
          path, 0, role + "s",
          "the record's " + role + " \"" + name + "\" is not among those of the model, " + join(names)});
    }
    out.push_back(found - names.begin());
  }
  return out;
}

Result<SampledModel> pick_channels(const NamedModel& named, const RecordChannels& record,
                                   const std::string& path) {
  const auto inputs = channel_places(record.inputs, named.inputs, "input", path);
  if (!inputs) return fail(inputs.error());
  const auto outputs = channel_places(record.outputs, named.outputs, "output", path);
  if (!outputs) return fail(outputs.error());
  return SampledModel{named.model.a, named.model.b(Eigen::all, *inputs), named.model.c(*outputs, Eigen::all),
                      named.model.d(*outputs, *inputs)};
}

}  // namespace fatmc
