#include <string>

#include "campaigns/base/prepared_trials.h"
#include "campaigns/candidates/study_figures.h"
#include "campaigns/candidates/summary.h"

namespace fatmc::candidates {
namespace {

void add_figures(const CellData& cell, std::vector<StudyFigure>& out) {
  const Selection& first = cell.spec.selections.front();
  const Selected of_first = select(cell.table, first);
  out.push_back(roll_history_figure(cell, of_first, first.order));
  out.push_back(accuracy_figure(cell, of_first, first.order));
  out.push_back(order_figure(cell));
  const std::optional<MeasuredResponse> measured = measured_response(cell.spec, cell.flown);
  out.push_back(best_response_figure(cell, of_first, first.order, measured));
  for (const Selection& selection : cell.spec.selections)
    out.push_back(window_figure(cell, selection, select(cell.table, selection)));
  out.push_back(candidate_response_figure(cell, measured));
  const Selection& last = cell.spec.selections.back();
  const Selected of_last = select(cell.table, last);
  for (const bool roll : {false, true}) out.push_back(impulse_figure(cell, last, of_last, roll));
  for (const bool roll : {false, true}) out.push_back(level_figure(cell, last, of_last, roll));
}

}  // namespace

Result<std::vector<StudyFigure>> figures(const CampaignSpec& spec, const RowSource& rows) {
  std::vector<StudyFigure> out;
  for (std::uint32_t cell = 0; cell < spec.cells.size(); ++cell) {
    const auto own = spec_of_cell(spec, cell);
    if (!own) return fail(own.error());
    const auto decoded = decode_candidates(*own);
    if (!decoded) return fail(decoded.error());
    const auto read = read_models(cell, rows);
    if (!read) return fail(read.error());
    const ModelTable& table = *read;
    if (table.models.empty() || decoded->selections.empty()) continue;
    const FlownTest flown = recorded_test(decoded->truth, decoded->flight, spec.trial_seed({cell, 0}));
    add_figures({*decoded, flown, table, spec.cells.size() == 1 ? "" : ", " + spec.cells[cell].name}, out);
  }
  return out;
}

}  // namespace fatmc::candidates
