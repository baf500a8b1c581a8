#include "coordinator/input/record_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "campaigns/base/decoder.h"
#include "coordinator/input/mat_file.h"
#include "coordinator/input/toml_file.h"
#include "core/base/text.h"
#include "core/record/column_file.h"
#include "core/record/periodicity.h"

namespace fatmc {
namespace {

/// What a file offers: samples under names, and how to say that a name is not among them.
struct Source {
  Columns columns;
  std::string lacks;                ///< "the CSV has no column"
  std::vector<std::string> offers;  ///< all names that it has
};

/// Columns of the names under `key`; a name that the file lacks is rejected.
std::vector<int> role(Decoder& table, const char* key, const Record& record, const Source& source,
                      bool required) {
  std::vector<int> columns;
  std::vector<std::string> names = required ? table.texts(key) : table.texts(key, std::vector<std::string>{});
  for (const std::string& name : names) {
    const int c = record.column(name);
    if (c < 0) {
      table.reject(key, source.lacks + " \"" + name + "\", it has " + join(source.offers));
    } else if (std::find(columns.begin(), columns.end(), c) != columns.end()) {
      table.reject(key, "names \"" + name + "\" twice");
    } else {
      columns.push_back(c);
    }
  }
  return columns;
}

Status decode(const Tree& file, const Source& source, Record& record) {
  Decoder top(file, "");
  const Tree* tree = top.table("record");
  if (tree == nullptr) return top.finish();
  Decoder table(*tree, "record");
  record.rate_hz = table.has("rate_hz") ? table.real("rate_hz", {.low = 1e-9, .high = 1e9}) : 0.0;
  record.reference = role(table, "reference", record, source, false);
  record.input = role(table, "input", record, source, true);
  record.output = role(table, "output", record, source, true);
  record.auxiliary = role(table, "auxiliary", record, source, false);
  constexpr std::int64_t kMost = 1'000'000'000;
  record.period_samples = static_cast<int>(table.integer("period_samples", {.low = 3, .high = kMost}, 0));
  record.periods = static_cast<int>(table.integer("periods", {.low = 1, .high = kMost}, 0));
  for (const double line :
       table.reals("excited_lines", 0, {.low = 1.0, .high = 1e9}, std::vector<double>{})) {
    if (line != std::floor(line)) table.reject("excited_lines", shortest(line) + " is not a whole harmonic");
    record.excited_lines.push_back(static_cast<int>(line));
  }
  if (!record.excited_lines.empty() && record.period_samples == 0) {
    table.reject("excited_lines", "are harmonics of a period, give period_samples too");
  }
  if (table.has("controller_gain")) {
    // Empty roles are refused by validate(); a gain has no shape before that.
    if (record.input.empty() || record.output.empty()) {
      table.reject(record.input.empty() ? "input" : "output", "names no column, write at least one");
      return table.finish();
    }
    const auto rows = table.matrix("controller_gain", record.input.size(), record.output.size());
    Eigen::MatrixXd gain(static_cast<Eigen::Index>(record.input.size()),
                         static_cast<Eigen::Index>(record.output.size()));
    gain.setZero();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t j = 0; j < rows[i].size(); ++j) {
        gain(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = rows[i][j];
      }
    }
    record.controller_gain = gain;
  }
  record.hold = table.choice("hold", {"zoh", "continuous"}, "zoh") == "zoh" ? Hold::zoh : Hold::continuous;
  if (table.has("trim_speed_m_s"))
    record.trim_speed_m_s = table.real("trim_speed_m_s", {.low = 1e-3, .high = 1e4});
  // Other tables of the file ([environment]) belong to other commands.
  return table.finish();
}

/// Names in the roles of a record's TOML, and t; what is no list of names is left to decode().
std::vector<std::string> channel_names(const Tree& file) {
  std::vector<std::string> out;
  const Tree* record = file.find("record");
  for (const char* key : {"reference", "input", "output", "auxiliary"}) {
    const Tree* names = record != nullptr && record->table() != nullptr ? record->find(key) : nullptr;
    if (names == nullptr || names->array() == nullptr) continue;
    for (const Tree& name : names->array()->items) {
      if (const auto* text = std::get_if<std::string>(&name.value)) out.push_back(*text);
    }
  }
  out.emplace_back("t");
  return out;
}

Result<Source> read_source(const std::string& path, const Tree& toml) {
  if (is_mat_file(path)) {
    Result<MatChannels> channels = read_mat_channels(path, channel_names(toml));
    if (!channels) return fail(channels.error());
    return Source{std::move(channels->columns), "the MAT file has no variable",
                  std::move(channels->variables)};
  }
  Result<Columns> columns = read_columns(path);
  if (!columns) return fail(columns.error());
  Source source{std::move(*columns), "the CSV has no column", {}};
  source.offers = source.columns.names;
  return source;
}

/// Rate of the column t; a MAT file has samples where a CSV has lines.
Result<double> rate_of(const Record& record, int t, const std::string& path) {
  Result<double> rate = rate_from_time(record.samples.col(t), path);
  if (!rate && is_mat_file(path) && rate.error().line > 0) {
    Error error = rate.error();
    error.message = "sample " + std::to_string(error.line - 1) + ": " + error.message;
    error.line = 0;
    return fail(error);
  }
  return rate;
}

}  // namespace

std::string record_toml_beside(const std::string& path) {
  return std::filesystem::path(path).replace_extension(".toml").string();
}

Result<Record> read_record(const std::string& path, const std::string& toml_path) {
  const std::string meta = toml_path.empty() ? record_toml_beside(path) : toml_path;
  if (!std::filesystem::exists(path))
    return fail(Error{path, 0, "", "does not exist, name a CSV or MAT file"});
  if (!std::filesystem::exists(meta)) {
    return fail(Error{meta, 0, "",
                      "does not exist: a record needs a TOML with a table [record] that names its input "
                      "and output columns (beside it, or --meta FILE)"});
  }
  Result<Tree> tree = read_toml(meta);
  if (!tree) return fail(tree.error());
  Result<Source> source = read_source(path, *tree);
  if (!source) return fail(source.error());
  Record record;
  record.names = source->columns.names;
  record.samples = std::move(source->columns.values);
  if (Status status = decode(*tree, *source, record); !status) return fail(status.error());
  if (const int t = record.column("t"); t >= 0) {
    const Result<double> rate = rate_of(record, t, path);
    if (!rate) return fail(rate.error());
    if (record.rate_hz > 0.0 && std::abs(*rate / record.rate_hz - 1.0) > 1e-3) {
      return fail(Error{path, 0, "t",
                        "runs at " + significant(*rate, 6) + " Hz, rate_hz in " + meta + " is " +
                            shortest(record.rate_hz)});
    }
    if (record.rate_hz == 0.0) record.rate_hz = *rate;
  }
  if (Status status = validate(record, path); !status) return fail(status.error());
  return record;
}

Result<Record> read_stream_roles(const std::string& stream, const std::vector<std::string>& names,
                                 const std::string& toml_path) {
  Result<Tree> tree = read_toml(toml_path);
  if (!tree) return fail(tree.error());
  Record record;
  record.names = names;
  if (Status status = decode(*tree, {{}, stream + " has no column", names}, record); !status) return fail(status.error());
  const auto needs = [&](const char* key) {
    return fail(Error{toml_path, 0, std::string("record.") + key, "is needed for samples that arrive one by one"});
  };
  if (record.rate_hz == 0.0) return needs("rate_hz");
  if (record.period_samples == 0) return needs("period_samples");
  if (record.excited_lines.empty()) return needs("excited_lines");
  return record;
}

Status complete_period(Record& record, const std::string& file) {
  const bool referenced = !record.reference.empty();
  const Eigen::MatrixXd excitation = record.channels(referenced ? record.reference : record.input);
  const std::string what = referenced ? "reference" : "input";
  if (record.period_samples == 0) {
    record.period_samples = find_period(excitation);
    if (record.period_samples == 0) {
      return fail(Error{file, 0, "period_samples",
                        "the " + what +
                            " does not repeat within the record: the method "
                            "needs two whole periods of a periodic excitation"});
    }
    if (Status status = validate(record, file); !status) return status;
  }
  if (record.periods < 2) {
    return fail(Error{file, 0, "periods", "the record holds one period, the method needs two or more"});
  }
  if (referenced) {
    const double error = repetition_error(excitation, record.period_samples);
    if (error > 0.05) {
      return fail(Error{file, 0, "period_samples",
                        "the reference does not repeat after " + std::to_string(record.period_samples) +
                            " samples (" + significant(100.0 * error, 3) + " % of its variance differs)"});
    }
  }
  if (record.excited_lines.empty()) {
    Result<std::vector<int>> lines = find_excited_lines(excitation, record.period_samples);
    if (!lines) return fail(Error{file, 0, "excited_lines", lines.error().message});
    record.excited_lines = std::move(*lines);
  }
  return {};
}

}  // namespace fatmc
