// fatmc query: canned views or SQL over a database, read-only.
#include <SQLiteCpp/SQLiteCpp.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>

#include "coordinator/cli/command.h"
#include "coordinator/cli/command_sensitivity.h"
#include "coordinator/cli/database_use.h"
#include "coordinator/store/campaign_store.h"
#include "coordinator/store/database_error.h"
#include "coordinator/store/schema.h"
#include "core/base/text.h"

namespace fatmc::cli {
namespace {

struct QueryOptions {
  std::string path, view = "cells", sql, array, format = "table";
};

// Blobs are arrays of doubles, but for hashes and the spec, which are shown as hexadecimal digits.
std::string blob_text(const SQLite::Column& column) {
  const auto* bytes = static_cast<const unsigned char*>(column.getBlob());
  const auto size = static_cast<std::size_t>(column.getBytes());
  std::string out;
  if (std::strcmp(column.getName(), "data") == 0 && size % sizeof(double) == 0) {
    for (std::size_t i = 0; i < size; i += sizeof(double)) {
      double value = 0.0;
      std::memcpy(&value, bytes + i, sizeof value);
      out += (i > 0 ? " " : "") + shortest(value);
    }
    return out;
  }
  char digits[3];
  for (std::size_t i = 0; i < size; ++i) {
    std::snprintf(digits, sizeof digits, "%02x", bytes[i]);
    out += digits;
  }
  return out;
}

std::string text_of(const SQLite::Column& column) {
  if (column.isNull()) return "";
  if (column.isBlob()) return blob_text(column);
  if (column.isFloat()) return shortest(column.getDouble());
  return column.getString();
}

std::vector<double> read_reals(const SQLite::Column& column) {
  std::vector<double> values(static_cast<std::size_t>(column.getBytes()) / sizeof(double));
  if (!values.empty()) std::memcpy(values.data(), column.getBlob(), values.size() * sizeof(double));
  return values;
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

nlohmann::ordered_json json_value(const SQLite::Column& column) {
  if (column.isNull()) return nullptr;
  if (column.isInteger()) return column.getInt64();
  if (column.isFloat())
    return std::isfinite(column.getDouble()) ? nlohmann::ordered_json(column.getDouble()) : nullptr;
  if (column.isBlob() && std::strcmp(column.getName(), "data") == 0 && column.getBytes() % 8 == 0) {
    return read_reals(column);
  }
  return text_of(column);
}

void print_csv(SQLite::Statement& query) {
  for (int i = 0; i < query.getColumnCount(); ++i) {
    std::printf("%s%s", i > 0 ? "," : "", csv_field(query.getColumnName(i)).c_str());
  }
  std::printf("\n");
  while (query.executeStep()) {
    for (int i = 0; i < query.getColumnCount(); ++i) {
      std::printf("%s%s", i > 0 ? "," : "", csv_field(text_of(query.getColumn(i))).c_str());
    }
    std::printf("\n");
  }
}

void print_json(SQLite::Statement& query) {
  bool first = true;
  std::printf("[");
  while (query.executeStep()) {
    nlohmann::ordered_json row = nlohmann::ordered_json::object();
    for (int i = 0; i < query.getColumnCount(); ++i)
      row[query.getColumnName(i)] = json_value(query.getColumn(i));
    std::printf("%s\n%s", first ? "" : ",",
                row.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
    first = false;
  }
  std::printf("\n]\n");
}

void print_table(SQLite::Statement& query) {
  constexpr std::size_t kWidest = 60;
  std::vector<std::vector<std::string>> lines(1);
  for (int i = 0; i < query.getColumnCount(); ++i) lines[0].emplace_back(query.getColumnName(i));
  while (query.executeStep()) {
    auto& line = lines.emplace_back();
    for (int i = 0; i < query.getColumnCount(); ++i) {
      std::string text = text_of(query.getColumn(i));
      if (text.size() > kWidest) text = text.substr(0, kWidest - 3) + "...";
      line.push_back(std::move(text));
    }
  }
  std::vector<std::size_t> widths(lines[0].size());
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  for (const auto& line : lines) {
    std::string out;
    for (std::size_t i = 0; i < line.size(); ++i)
      out += line[i] + std::string(widths[i] - line[i].size() + 2, ' ');
    out.erase(out.find_last_not_of(' ') + 1);
    std::printf("%s\n", out.c_str());
  }
}

// One array of all trials as a matrix for numpy, pandas or a spreadsheet: a row a trial, a column an element.
// Rows may differ in length; NaN and infinities are nan and inf.
Exit print_array(const CampaignReader& reader, const QueryOptions& options) {
  SQLite::Statement rows(reader.database(),
                         "SELECT cell, repetition, data FROM arrays WHERE name = ? AND count > 0");
  rows.bind(1, options.array);
  bool first = true;
  while (rows.executeStep()) {
    const std::vector<double> values = read_reals(rows.getColumn(2));
    if (first) {
      std::printf("cell,repetition");
      for (std::size_t i = 0; i < values.size(); ++i) std::printf(",%zu", i);
      std::printf("\n");
      first = false;
    }
    std::printf("%s,%lld", csv_field(rows.getColumn(0).getString()).c_str(),
                static_cast<long long>(rows.getColumn(1).getInt64()));
    for (const double value : values) std::printf(",%s", shortest(value).c_str());
    std::printf("\n");
  }
  if (!first) return Exit::done;
  std::string names;
  SQLite::Statement known(reader.database(), "SELECT DISTINCT name FROM arrays ORDER BY 1");
  while (known.executeStep()) names += (names.empty() ? "" : ", ") + known.getColumn(0).getString();
  return report(
      {"", 0, "--array",
       "no row has an array \"" + options.array + "\"" + (names.empty() ? "" : ", write one of: " + names)});
}

Exit query(const QueryOptions& options) {
  const Result<CampaignReader> reader = CampaignReader::open(options.path);
  if (!reader) return report(reader.error());
  if (!options.array.empty()) return print_array(*reader, options);
  const std::string sql = options.sql.empty() ? "SELECT * FROM " + options.view : options.sql;
  try {
    SQLite::Statement statement(reader->database(), sql);
    if (statement.getColumnCount() == 0) {
      return report({"", 0, "--sql", "gives no rows, write a SELECT (the database is opened read-only)"});
    }
    if (options.format == "csv") {
      print_csv(statement);
    } else if (options.format == "json") {
      print_json(statement);
    } else {
      print_table(statement);
    }
  } catch (const SQLite::Exception& e) {
    if (options.sql.empty() || is_damage(e)) throw;
    return report({"", 0, "--sql", e.what()});
  }
  return Exit::done;
}

}  // namespace

void add_query_command(CLI::App& app, Exit& exit) {
  auto options = std::make_shared<QueryOptions>();
  CLI::App* command = app.add_subcommand("query", "reads a database: a view, or any SQL");
  std::string footer = "Views and what they answer:\n";
  std::vector<std::string> views;
  for (const ViewDescription& view : kViews) {
    views.emplace_back(view.name);
    footer +=
        "  " + views.back() + std::string(20 - views.back().size(), ' ') + std::string(view.question) + "\n";
  }
  command->footer(
      footer +
      "Their columns are described in docs/schema.md; array data are shown as numbers.\n"
      "Example: fatmc query results/coverage.db --view failures\n"
      "    and: fatmc query results/coverage.db --format csv --sql \"SELECT name, avg(value) FROM metrics "
      "GROUP BY 1\"\n"
      "    and: fatmc query results/coverage.db --array error_re > error_re.csv");
  command->add_option("DB", options->path, "database");
  auto* view = command->add_option("--view", options->view, "what to show")
                   ->check(CLI::IsMember(views))
                   ->capture_default_str();
  auto* sql = command->add_option("--sql", options->sql, "a SELECT of your own")->excludes(view);
  command
      ->add_option("--array", options->array,
                   "one array of all trials as CSV: a row a trial, a column an element")
      ->excludes(view)
      ->excludes(sql);
  command->add_option("--format", options->format, "layout")
      ->check(CLI::IsMember({"table", "csv", "json"}))
      ->capture_default_str();
  command->require_subcommand(0, 1);
  add_sensitivity_command(*command, exit);
  command->callback([command, options, &exit] {
    if (!command->get_subcommands().empty()) return;
    if (options->path.empty()) {
      exit = report(Error{"", 0, "DB", "is missing, write the database (fatmc query --help)"});
      return;
    }
    exit = use_database(options->path, [&] { return query(*options); });
  });
}

}  // namespace fatmc::cli
