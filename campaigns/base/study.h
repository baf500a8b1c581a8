// The two halves of a study: trials (in the workers) and summary (in the coordinator).
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "campaigns/base/campaign_spec.h"
#include "campaigns/base/figure.h"
#include "campaigns/base/trial_record.h"
#include "campaigns/base/trial_row.h"
#include "core/base/error.h"

namespace fatmc {

/// Everything a cell needs, prepared once a process (design matrices, trim, references); const afterwards and
/// safe to use from several threads at once.
class PreparedCell {
 public:
  virtual ~PreparedCell() = default;
  /// The trial: a pure function of spec, cell and repetition. Expected failures are outcomes, not exceptions.
  [[nodiscard]] virtual TrialRow run(std::uint64_t repetition) const = 0;
  /// The flight behind that row, flown again; none where the study flies nothing.
  [[nodiscard]] virtual std::optional<TrialRecord> record(std::uint64_t) const { return std::nullopt; }
};

struct TrialStudy {
  std::string name;
  /// Decodes what belongs to the study and prepares a cell; the error names file, line and key.
  Result<std::unique_ptr<PreparedCell>> (*prepare)(const CampaignSpec& spec, std::uint32_t cell);
};

/// One line of `fatmc tables`: a published figure beside ours.
struct TableRow {
  std::string table;     ///< "5-5"
  std::string row;       ///< "95 %"
  std::string quantity;  ///< which variant: "with bias, as printed (5.14)"
  std::string unit;
  double published = 0.0;  ///< NaN where nothing is printed
  double value = 0.0;
  double low = 0.0,
         high = 0.0;    ///< 95 % prediction interval behind the verdict, at the published size; NaN: none
  std::uint64_t n = 0;  ///< trials behind `value`
  std::string verdict;  ///< exact, match, shape, differs; "" where nothing is printed
  std::string why;
};

/// Reads rows of one cell in the order of repetitions, calling back for each.
using RowSource = std::function<void(std::uint32_t cell, const std::function<void(const TrialRow&)>& visit)>;

/// A figure of the report.
struct StudyFigure {
  std::string id;       ///< "Fig. 5-4", or a short title of our own
  std::string caption;  ///< what is shown, from how many runs, what the bands are
  plot::Figure figure;
};

struct SummaryStudy {
  std::string name;
  Result<std::vector<TableRow>> (*tables)(const CampaignSpec& spec, const RowSource& rows);
  /// In the order in which the report shows them; null where the study draws nothing.
  Result<std::vector<StudyFigure>> (*figures)(const CampaignSpec& spec, const RowSource& rows) = nullptr;
};

}  // namespace fatmc
