// The figures of H, each from the models of one cell.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "campaigns/base/study.h"
#include "campaigns/candidates/flight_test.h"
#include "campaigns/candidates/model_table.h"

namespace fatmc::candidates {

/// What the figures of a cell are made of.
struct CellData {
  const CandidatesSpec& spec;
  const FlownTest& flown;
  const ModelTable& table;
  std::string suffix;  ///< of ids and titles: the cell's name where there are several
};

/// Fig. 2: measured roll rate of a lateral multistep with two models, about as far apart in d1 as those of H.
StudyFigure roll_history_figure(const CellData& cell, const Selected& selected, int order);
/// Fig. 3: d1 against rms error, of that roll rate and over all outputs, with the rating (12).
StudyFigure accuracy_figure(const CellData& cell, const Selected& selected, int order);
/// Fig. 4: d1 by model order.
StudyFigure order_figure(const CellData& cell);
/// Figs. 6 and 7: norm of A_K^p and d1 by past window.
StudyFigure window_figure(const CellData& cell, const Selection& selection, const Selected& selected);

/// p/delta_y as the sweeps have it: estimated over all of them together (joint_records.h), within the band in
/// which they excite.
struct MeasuredResponse {
  std::vector<double> frequency_rad_s, decibel;
};
/// None where the estimator refuses the sweeps.
std::optional<MeasuredResponse> measured_response(const CandidatesSpec& spec, const FlownTest& flown);

/// Fig. 5: p/delta_y of all models and of the best by d1.
StudyFigure best_response_figure(const CellData& cell, const Selected& selected, int order,
                                 const std::optional<MeasuredResponse>& measured);
/// Fig. 8: of the candidates of every selection.
StudyFigure candidate_response_figure(const CellData& cell, const std::optional<MeasuredResponse>& measured);

/// Figs. 9 and 10: impulse responses of the candidates and of the truth, bare and stabilized in pitch,
/// stabilized and optimized in roll.
StudyFigure impulse_figure(const CellData& cell, const Selection& selection, const Selected& selected,
                           bool roll);
/// Figs. 11 and 12: oscillations that show in those responses, with the levels of ADS-33.
StudyFigure level_figure(const CellData& cell, const Selection& selection, const Selected& selected,
                         bool roll);

/// The three vehicles of kJudged around a discrete model; empty where it has no continuous counterpart.
std::vector<ContinuousModel> vehicles_of(const DiscreteModel& model, double rate_hz);

}  // namespace fatmc::candidates
