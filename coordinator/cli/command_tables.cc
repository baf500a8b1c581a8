// fatmc tables: published figures beside ours, from formulas and from databases that exist.
#include <algorithm>
#include <map>
#include <memory>

#include "coordinator/cli/command.h"
#include "coordinator/cli/database_use.h"
#include "coordinator/cli/formula_results.h"
#include "coordinator/cli/study_results.h"
#include "coordinator/report/tables.h"

namespace fatmc::cli {
namespace {

struct Options {
  std::vector<std::string> databases;
  std::string only;
  std::string format = "text";
};

std::vector<std::string> names_of(const std::vector<TableRow>& rows) {
  std::vector<std::string> names;
  for (const TableRow& row : rows) {
    if (std::find(names.begin(), names.end(), row.table) == names.end()) names.push_back(row.table);
  }
  return names;
}

// "5-5" means "5-5", or else the table whose name ends so: "Fig. 5-4" for "5-4", "Section 5.2.3" for "5.2.3". Headings and the
// words for a figure are understood, too.
std::string full_name(const std::vector<std::string>& known, std::string wanted) {
  for (const std::string prefix : {"Table ", "table ", "Figure ", "figure ", "Fig ", "fig ", "fig. "}) {
    if (wanted.starts_with(prefix)) wanted.erase(0, prefix.size());
  }
  if (std::find(known.begin(), known.end(), wanted) != known.end()) return wanted;
  for (const std::string& name : known) {
    if (name.ends_with(" " + wanted)) return name;
  }
  return "";
}

Exit run(const Options& options) {
  std::vector<std::string> databases = options.databases;
  std::vector<TableRow> rows = tables_without_database();
  if (!options.only.empty() && !full_name(names_of(rows), options.only).empty()) {
    databases.clear();  // a formula table needs no database, not even one that cannot be read
  } else if (databases.empty()) {
    databases = last_databases();
  } else {
    rows.clear();
  }
  for (const std::string& path : each_once(databases)) {
    const Exit exit = use_database(path, [&] {
      const auto database = StudyDatabase::open(path);
      if (!database) return report(database.error());
      const auto more = database->tables();
      if (!more) return report(more.error());
      rows.insert(rows.end(), more->begin(), more->end());
      return Exit::done;
    });
    if (exit != Exit::done) return exit;
  }
  if (!options.only.empty()) {
    const std::vector<std::string> known = names_of(rows);
    const std::string only = full_name(known, options.only);
    if (only.empty()) {
      std::string list;
      for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
      return report(Error{"", 0, "--only",
                          "no table \"" + options.only + "\" among formulas and databases" +
                              (list.empty() ? "" : ", write one of: " + list) +
                              "; further ones come with the campaign that fills them"});
    }
    std::erase_if(rows, [&](const TableRow& row) { return row.table != only; });
  }
  const std::map<std::string, TableFormat> formats = {
      {"text", TableFormat::text}, {"markdown", TableFormat::markdown}, {"json", TableFormat::json}};
  print_tables(rows, formats.at(options.format));
  return Exit::done;
}

}  // namespace

void add_tables_command(CLI::App& app, Exit& exit) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("tables", "published figures beside ours, from formulas and databases");
  command->add_option("DB", options->databases,
                      "databases; without any, the formula tables and those of the last run (results/last)");
  command->add_option("--only", options->only, "one table, for instance 5-5");
  command->add_option("--format", options->format, "text, markdown or json")
      ->check(CLI::IsMember({"text", "markdown", "json"}))
      ->capture_default_str();
  command->footer("Example: fatmc tables results/coverage.db --only 5-5");
  command->callback([options, &exit] { exit = run(*options); });
}

}  // namespace fatmc::cli
