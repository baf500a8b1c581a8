// What databases say: the tables and figures of their studies, as `fatmc tables` and `fatmc report` show them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "campaigns/base/study.h"
#include "coordinator/store/campaign_store.h"
#include "core/base/error.h"

namespace fatmc::cli {

/// The databases of the last run (results/last, one a line); none where nothing has run yet.
std::vector<std::string> last_databases();

/// Without those that name a file again that stands before: a campaign is shown once, and a note on standard error says so.
std::vector<std::string> each_once(const std::vector<std::string>& databases);

/// A database with the study that can read it.
class StudyDatabase {
 public:
  /// Fails on a file that is no database of ours, of an older schema, or of a study without tables in this program. A
  /// database that another build computed is a note on standard error: its numbers are that build's.
  static Result<StudyDatabase> open(const std::string& path);

  [[nodiscard]] const CampaignReader& reader() const { return reader_; }
  /// Rows of a partial campaign say so in `why`.
  [[nodiscard]] Result<std::vector<TableRow>> tables() const;
  [[nodiscard]] Result<std::vector<StudyFigure>> figures() const;
  [[nodiscard]] std::uint64_t planned() const { return reader_.spec().trial_count(); }

 private:
  StudyDatabase(std::string path, CampaignReader reader, const SummaryStudy* study)
      : path_(std::move(path)), reader_(std::move(reader)), study_(study) {}
  /// An error of the rows is one of the file.
  [[nodiscard]] Error placed(Error error) const;
  std::string path_;
  CampaignReader reader_;
  const SummaryStudy* study_;
};

}  // namespace fatmc::cli
