#include "coordinator/cli/study_results.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "campaigns/registry_summaries.h"
#include "core/base/build_hash.h"

namespace fatmc::cli {

std::vector<std::string> last_databases() {
  std::ifstream in("results/last");
  std::vector<std::string> out;
  for (std::string line; std::getline(in, line);) {
    if (!line.empty()) out.push_back(line);
  }
  return out;
}

std::vector<std::string> each_once(const std::vector<std::string>& databases) {
  std::vector<std::string> out;
  std::vector<std::filesystem::path> known;
  for (const std::string& path : databases) {
    std::error_code ignored;
    const std::filesystem::path file = std::filesystem::weakly_canonical(path, ignored);
    if (std::find(known.begin(), known.end(), file) != known.end()) {
      std::fprintf(stderr, "fatmc: note: %s is given twice and shown once\n", path.c_str());
      continue;
    }
    known.push_back(file);
    out.push_back(path);
  }
  return out;
}

Result<StudyDatabase> StudyDatabase::open(const std::string& path) {
  auto reader = CampaignReader::open(path);
  if (!reader) return fail(reader.error());
  const SummaryStudy* study = find_summary_study(reader->spec().study);
  if (study == nullptr) {
    return fail(
        Error{path, 0, "study",
              "\"" + reader->spec().study +
                  "\" has no tables in this program, use the one that made the database, or fatmc query"});
  }
  if (reader->build() != build_hash()) {
    std::fprintf(
        stderr,
        "fatmc: note: %s: its trials were computed by build %s, this is %s; for the numbers of this build "
        "run the spec into a new database\n",
        path.c_str(), reader->build().substr(0, 12).c_str(), build_hash().substr(0, 12).c_str());
  }
  return StudyDatabase(path, std::move(*reader), study);
}

Error StudyDatabase::placed(Error error) const {
  if (error.file.empty()) error.file = path_;
  return error;
}

Result<std::vector<TableRow>> StudyDatabase::tables() const {
  auto rows = study_->tables(reader_.spec(), reader_.rows());
  if (!rows) return fail(placed(rows.error()));
  const std::uint64_t stored = reader_.stored();
  if (stored >= planned()) return rows;
  const std::string partial =
      "partial: " + std::to_string(stored) + " of " + std::to_string(planned()) + " trials are stored";
  for (TableRow& row : *rows) row.why = partial + (row.why.empty() ? "" : "; " + row.why);
  return rows;
}

Result<std::vector<StudyFigure>> StudyDatabase::figures() const {
  if (study_->figures == nullptr) return std::vector<StudyFigure>{};
  auto figures = study_->figures(reader_.spec(), reader_.rows());
  if (!figures) return fail(placed(figures.error()));
  return figures;
}

}  // namespace fatmc::cli
