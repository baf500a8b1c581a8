// fatmc report: one page of everything that databases say, and its figures as files.
#include <SQLiteCpp/SQLiteCpp.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>

#include "coordinator/cli/command.h"
#include "coordinator/cli/database_use.h"
#include "coordinator/cli/formula_results.h"
#include "coordinator/cli/output_path.h"
#include "coordinator/cli/study_results.h"
#include "coordinator/plot/svg.h"
#include "coordinator/report/campaign_page.h"
#include "core/base/build_hash.h"

namespace fatmc::cli {
namespace {

struct Options {
  std::vector<std::string> databases;
  std::string page, figures;
  std::string title = "fatmc report";
};

// Who computed the rows, and when: a host a line.
std::vector<std::pair<std::string, std::string>> hosts_of(SQLite::Database& database) {
  SQLite::Statement query(
      database, "SELECT host, count(*), min(started), max(finished) FROM trials GROUP BY host ORDER BY host");
  std::vector<std::pair<std::string, std::string>> out;
  while (query.executeStep()) {
    out.emplace_back("host " + query.getColumn(0).getString(),
                     query.getColumn(1).getString() + " trials from " + query.getColumn(2).getString() +
                         " to " + query.getColumn(3).getString());
  }
  return out;
}

std::vector<std::pair<std::string, std::string>> provenance_of(const std::string& path,
                                                               const CampaignReader& reader) {
  const CampaignSpec& spec = reader.spec();
  std::vector<std::pair<std::string, std::string>> out = {
      {"database", path},
      {"study, seed", spec.study + ", " + std::to_string(spec.seed)},
      {"spec (SHA-256)", spec.identity()},
      {"build of the results",
       reader.build() + (reader.build() == build_hash() ? "" : " (not this program's)")},
      {"build of this page", build_hash()},
      {"results (fatmc digest)", reader.digest()}};
  for (auto& host : hosts_of(reader.database())) out.push_back(std::move(host));
  return out;
}

// What sets a cell apart: its own keys, and the values of its table `set`.
std::vector<std::pair<std::string, std::string>> settings_of(const Cell& cell) {
  std::vector<std::pair<std::string, std::string>> out;
  const Tree::Table* table = cell.tree.table();
  for (const auto& [key, value] : table->entries) {
    if (key == "name" || key == "repetitions" || key == "priority") continue;
    if (key != "set" || value.table() == nullptr) {
      out.emplace_back(key, canonical_text(value));
      continue;
    }
    for (const auto& [path, set] : value.table()->entries) out.emplace_back(path, canonical_text(set));
  }
  return out;
}

Result<CampaignPage> page_of(const std::string& path) {
  auto database = StudyDatabase::open(path);
  if (!database) return fail(database.error());
  const CampaignReader& reader = database->reader();
  const CampaignSpec& spec = reader.spec();
  CampaignPage out;
  out.name = spec.name;
  out.title = spec.title;
  out.stored = reader.stored();
  out.planned = database->planned();
  auto rows = database->tables();
  if (!rows) return fail(rows.error());
  out.rows = std::move(*rows);
  auto figures = database->figures();
  if (!figures) return fail(figures.error());
  out.figures = std::move(*figures);
  const RowSource without_arrays = [&](std::uint32_t cell,
                                       const std::function<void(const TrialRow&)>& visit) {
    reader.visit(cell, visit, {.arrays = false});
  };
  for (std::uint32_t cell = 0; cell < spec.cells.size(); ++cell) {
    out.cells.push_back(
        summarise_cell(spec.cells[cell].name, spec.cells[cell].repetitions, cell, without_arrays));
    out.cells.back().settings = settings_of(spec.cells[cell]);
  }
  out.provenance = provenance_of(path, reader);
  return out;
}

CampaignPage formula_page() {
  CampaignPage out;
  out.name = "formulas";
  out.title = "Formulas and the FAT";
  out.rows = tables_without_database();
  out.figures = figures_without_database();
  return out;
}

// A name used twice would write one file over another, and break links.
void make_names_unique(std::vector<CampaignPage>& pages) {
  for (std::size_t i = 0; i < pages.size(); ++i) {
    const std::string name = pages[i].name;
    int copies = 1;
    for (std::size_t k = 0; k < i; ++k) copies += pages[k].name == name ? 1 : 0;
    if (copies > 1) pages[i].name = name + "-" + std::to_string(copies);
  }
}

Exit write_file(const std::string& path, const std::string& content) {
  const std::string fresh = path + ".new";
  std::ofstream out(fresh, std::ios::binary);
  out << content;
  out.close();
  std::error_code error;
  if (out) std::filesystem::rename(fresh, path, error);
  if (!out || error) {
    std::filesystem::remove(fresh, error);
    return report(Error{path, 0, "", "could not be written"}), Exit::failed;
  }
  return Exit::done;
}

Exit write_figures(const std::vector<CampaignPage>& pages, const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  for (const CampaignPage& page : pages) {
    for (const StudyFigure& figure : page.figures) {
      const std::string path = folder + "/" + figure_name(page, figure) + ".svg";
      if (const Exit exit = write_file(path, plot::svg_of(figure.figure)); exit != Exit::done) return exit;
    }
  }
  return Exit::done;
}

bool is_database(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string begin(15, '\0');
  return in.read(begin.data(), static_cast<std::streamsize>(begin.size())) && begin == "SQLite format 3";
}

Exit run(const Options& options) {
  if (Status status = check_output_file(options.page); !status) return report(status.error());
  if (is_database(options.page)) {
    return report(
        Error{options.page, 0, "-o", "is a database, which would be overwritten; write another file"});
  }
  if (!options.figures.empty()) {
    if (Status status = check_output_directory(options.figures, "--figures"); !status)
      return report(status.error());
  }
  const std::vector<std::string> databases =
      each_once(options.databases.empty() ? last_databases() : options.databases);
  std::vector<CampaignPage> pages = {formula_page()};
  for (const std::string& path : databases) {
    const Exit exit = use_database(path, [&] {
      auto page = page_of(path);
      if (!page) return report(page.error());
      pages.push_back(std::move(*page));
      return Exit::done;
    });
    if (exit != Exit::done) return exit;
  }
  make_names_unique(pages);
  const std::string html = campaign_page(options.title, pages);
  if (const Exit exit = write_file(options.page, html); exit != Exit::done) return exit;
  if (!options.figures.empty()) {
    if (const Exit exit = write_figures(pages, options.figures); exit != Exit::done) return exit;
  }
  std::size_t figures = 0;
  for (const CampaignPage& page : pages) figures += page.figures.size();
  std::printf("%s: %zu campaigns, %zu figures, %zu kB\n", options.page.c_str(), databases.size(), figures,
              (html.size() + 999) / 1000);
  return Exit::done;
}

}  // namespace

void add_report_command(CLI::App& app, Exit& exit) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("report", "one page of tables, figures, cells and provenance");
  command->add_option("DB", options->databases,
                      "databases; without any, those of the last run (results/last)");
  command->add_option("-o,--output", options->page, "FILE.html: opens from disk, without a network")
      ->required();
  command->add_option("--figures", options->figures, "folder for the figures as SVG files, for a paper");
  command->add_option("--title", options->title, "heading of the page")->capture_default_str();
  command->footer(
      "Example: fatmc report results/coverage.db -o results/coverage.html --figures results/figures");
  command->callback([options, &exit] { exit = run(*options); });
}

}  // namespace fatmc::cli
