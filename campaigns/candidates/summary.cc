#include "campaigns/candidates/summary.h"

#include <algorithm>
#include <array>
#include <string>

#include "campaigns/base/prepared_trials.h"
#include "campaigns/candidates/cell_tables.h"

namespace fatmc::candidates {

Result<std::vector<TableRow>> tables(const CampaignSpec& spec, const RowSource& rows) {
  const auto published = decode_published(spec);
  if (!published) return fail(published.error());
  std::vector<TableRow> out;
  for (std::uint32_t cell = 0; cell < spec.cells.size(); ++cell) {
    const auto own = spec_of_cell(spec, cell);
    if (!own) return fail(own.error());
    const auto decoded = decode_candidates(*own);
    if (!decoded) return fail(decoded.error());
    const auto read = read_models(cell, rows);
    if (!read) return fail(read.error());
    const ModelTable& table = *read;
    if (table.models.empty()) continue;
    const auto judged = judge_models(table, decoded->truth);
    if (!judged) return fail(judged.error());
    const CellTables cell_tables(
        spec.cells.size() == 1 ? "" : ", " + spec.cells[cell].name,
        compared_with_print(spec, cell) ? *published : std::vector<PublishedFigure>{}, out);
    add_accuracy_tables(table, decoded->selections, cell_tables);
    if (!decoded->selections.empty()) {
      const Selected first = select(table, decoded->selections.front());
      if (!first.all.empty()) add_roll_accuracy(table, first, cell_tables);
    }
    int highest = 0;
    for (const Selection& selection : decoded->selections) highest = std::max(highest, selection.order);
    for (const Selection& selection : decoded->selections) {
      const CellTables own_tables = cell_tables.with(", " + selection.limit_text());
      const Selected selected = select(table, selection);
      add_selection_tables(*judged, selection, selected, own_tables);
      // H analyses n = 18.
      if (selection.order == highest) add_prediction_tables(*judged, selected, own_tables);
    }
  }
  // Table by table, each in the order of cells and selections.
  const auto place = [](const TableRow& row) {
    static constexpr std::array kTables = {"Models",    "Fig. 3",      "Fig. 4",     "Validation",
                                           "Section 4", "Section 5.1", "Section 5.2"};
    return std::find(kTables.begin(), kTables.end(), row.table) - kTables.begin();
  };
  std::stable_sort(out.begin(), out.end(),
                   [&](const TableRow& one, const TableRow& other) { return place(one) < place(other); });
  return out;
}

const SummaryStudy kSummaryStudy{"candidates", &tables, &figures};

}  // namespace fatmc::candidates
