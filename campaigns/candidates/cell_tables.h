// The rows of one cell's tables, each with what print says of it.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "campaigns/base/verdict.h"
#include "campaigns/candidates/judged_models.h"

namespace fatmc::candidates {

inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
inline constexpr const char* kNoModel = "no model has a norm below the limit";
/// Behind every interval of a share of models.
inline constexpr const char* kRelatedModels =
    "the interval takes models for independent draws, which those of one flight test are not: it is too "
    "narrow";

/// Rows of one cell, with what print says of it.
class CellTables {
 public:
  CellTables(std::string suffix, std::vector<PublishedFigure> published, std::vector<TableRow>& out)
      : suffix_(std::move(suffix)), published_(std::move(published)), out_(out) {}

  TableRow row(const std::string& table, const std::string& name, const std::string& quantity,
               const std::string& unit, double value, std::uint64_t n) const {
    TableRow row = table_row(table, name, quantity, unit);
    row.published = published_value(published_, row);
    row.row += suffix_;
    row.value = value;
    row.n = n;
    return row;
  }

  /// The same for what the text of H claims, most often without a figure: `printed` stands for it where the cell is compared with
  /// print.
  TableRow claim(const std::string& table, const std::string& name, const std::string& quantity,
                 const std::string& unit, double value, std::uint64_t n, double printed) const {
    TableRow out = row(table, name, quantity, unit, value, n);
    if (!published_.empty()) out.published = printed;
    return out;
  }

  /// The same with more behind the names of its rows.
  [[nodiscard]] CellTables with(const std::string& more) const { return {more + suffix_, published_, out_}; }

  void add(TableRow row) const { out_.push_back(std::move(row)); }

  /// A claim of print without an interval of ours: same behaviour, or not.
  void add_claim(TableRow row, bool alike, const std::string& why) const {
    if (!std::isnan(row.published)) {
      row.verdict = alike ? "shape" : "differs";
      row.why += (row.why.empty() ? "" : "; ") + why;
    }
    out_.push_back(std::move(row));
  }

 private:
  std::string suffix_;
  std::vector<PublishedFigure> published_;
  std::vector<TableRow>& out_;
};

/// "Models", "Fig. 4" and "Validation": how many models there are, and how well those of each order repeat the multisteps.
void add_accuracy_tables(const ModelTable& table, const std::vector<Selection>& selections,
                         const CellTables& out);
/// "Fig. 3": d1 at the rms errors of H's two models.
void add_roll_accuracy(const ModelTable& table, const Selected& selected, const CellTables& out);
/// "Section 4": what a selection takes, and the resonances in it.
void add_selection_tables(const JudgedModels& models, const Selection& selection, const Selected& selected,
                          const CellTables& out);
/// "Section 5.1" and "Section 5.2": modes, CS-27 and ADS-33 of the candidates.
void add_prediction_tables(const JudgedModels& models, const Selected& selected, const CellTables& out);

}  // namespace fatmc::candidates
