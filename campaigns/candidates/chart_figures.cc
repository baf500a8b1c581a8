// Figs. 11 and 12: eigenvalues against the levels of ADS-33.
#include <algorithm>
#include <cmath>
#include <string>

#include "campaigns/candidates/model_analysis.h"
#include "campaigns/candidates/study_figures.h"
#include "core/handling/requirements.h"

namespace fatmc::candidates {
namespace {

constexpr double kLevel1Damping = 0.35;

plot::Points seen_modes(const CellData& cell, const std::vector<const DiscreteModel*>& models,
                        const JudgedResponse& judged) {
  plot::Points out;
  for (const DiscreteModel* model : models) {
    const std::vector<ContinuousModel> vehicles = vehicles_of(*model, cell.spec.truth.rate_hz);
    if (vehicles.empty()) continue;
    const auto shares =
        mode_shares(vehicles[static_cast<std::size_t>(judged.vehicle)], judged.output, judged.input);
    if (!shares) continue;
    for (const ModeShare& mode : *shares) {
      if (mode.share < kSeenShare || !mode.mode.oscillatory()) continue;
      out.x.push_back(mode.mode.s.real());
      out.y.push_back(mode.mode.s.imag());
    }
  }
  return out;
}

}  // namespace

StudyFigure level_figure(const CellData& cell, const Selection& selection, const Selected& selected,
                         bool roll) {
  std::vector<const DiscreteModel*> candidates;
  for (const std::size_t i : selected.candidates) {
    if (const ModelAnalysisRow* analysis = cell.table.analysis_of(i))
      candidates.push_back(&analysis->model.model);
  }
  const std::vector<const DiscreteModel*> truth = {&cell.spec.truth.model};
  plot::Panel panel;
  panel.x = {"real part, 1/s", plot::Scale::linear, {}, {}};
  panel.y = {"imaginary part, rad/s", plot::Scale::linear, {}, {}};
  double highest = 1.0, left = -1.0, right = 0.2;
  const std::size_t first = roll ? 2 : 0;
  for (const std::size_t k : {first, first + 1}) {
    const plot::Hue hue = k == 0 ? plot::Hue::grey : (k == 3 ? plot::Hue::orange : plot::Hue::blue);
    plot::Points points = seen_modes(cell, candidates, kJudged[k]), own = seen_modes(cell, truth, kJudged[k]);
    for (const plot::Points* set : {&points, &own}) {
      for (const double y : set->y) highest = std::max(highest, y);
      for (const double x : set->x) left = std::min(left, x), right = std::max(right, x);
    }
    points.name = kJudged[k].name;
    points.hue = own.hue = hue;
    own.name = std::string(kJudged[k].name) + ": truth";
    own.filled = false;
    own.radius_px = 4.0;
    panel.marks.push_back(std::move(points));
    panel.marks.push_back(std::move(own));
  }
  // From |s| = 0.5 rad/s on; below that level 1 begins at a damping of 0.
  const double slope = kLevel1Damping / std::sqrt(1.0 - kLevel1Damping * kLevel1Damping);
  panel.marks.push_back(plot::Line{"level 1 left of it: damping 0.35 (unverified)",
                                   {0.0, -0.5 * kLevel1Damping, -slope * highest},
                                   {0.5 * std::sqrt(1.0 - kLevel1Damping * kLevel1Damping),
                                    0.5 * std::sqrt(1.0 - kLevel1Damping * kLevel1Damping), highest},
                                   plot::Hue::green,
                                   plot::Dash::dashed});
  panel.marks.push_back(plot::Rule{"level 2 left of it: damping 0 (unverified)", 0.0, true, plot::Hue::red,
                                   plot::Dash::dashed});
  panel.x.range = plot::Range{1.05 * left, 1.2 * right};
  plot::Figure figure;
  figure.title = std::string("Dynamic stability in ") + (roll ? "roll" : "pitch") +
                 ", candidates of n = " + std::to_string(selection.order) + cell.suffix;
  figure.panel_width = 520.0;
  figure.panel_height = 320.0;
  figure.panels = {std::move(panel)};
  return {
      (roll ? "Fig. 12" : "Fig. 11") + cell.suffix + ", " + selection.limit_text(),
      "Oscillations whose peak in the response of the rate to its control is at least 5 % of the largest. "
      "Boundaries of ADS-33 from memory, unverified.",
      std::move(figure)};
}

}  // namespace fatmc::candidates
