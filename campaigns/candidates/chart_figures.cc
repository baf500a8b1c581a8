// Figs. 11 and 12: eigenvalues against the levels of ADS-33.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "campaigns/candidates/model_analysis.h"
#include "campaigns/candidates/study_figures.h"
#include "core/handling/requirements.h"

namespace fatmc::candidates {
namespace {

constexpr double kLevel1Damping = 0.35, kLow_rad_s = 0.5;

/// The boundaries of ads33_level in the upper half of the plane: level 1 from a damping of 0.35 on above 0.5 rad/s, of 0 below;
/// level 2 from 0 on above, below it no doubling within 10 s.
void add_boundaries(plot::Panel& panel, double highest) {
  const double slope = kLevel1Damping / std::sqrt(1.0 - kLevel1Damping * kLevel1Damping);
  plot::Line one{
      "level 1 left of it (unverified)", {0.0, 0.0}, {0.0, kLow_rad_s}, plot::Hue::green, plot::Dash::dashed};
  for (int k = 1; k <= 10; ++k) {
    const double damping = kLevel1Damping * k / 10.0;
    one.x.push_back(-kLow_rad_s * damping);
    one.y.push_back(kLow_rad_s * std::sqrt(1.0 - damping * damping));
  }
  one.x.push_back(-slope * highest);
  one.y.push_back(highest);
  const double growth = std::numbers::ln2 / 10.0;
  plot::Line two{"level 2 left of it (unverified)",
                 {growth, growth, 0.0, 0.0},
                 {0.0, std::sqrt(kLow_rad_s * kLow_rad_s - growth * growth), kLow_rad_s, highest},
                 plot::Hue::red,
                 plot::Dash::dashed};
  panel.marks.push_back(std::move(one));
  panel.marks.push_back(std::move(two));
}

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
  std::vector<plot::Points> truths;
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
    points.radius_px = k == first ? 3.0 : 1.8;  // modes that both vehicles have show as a dot in a dot
    own.name = std::string(kJudged[k].name) + ": truth";
    own.filled = false;
    own.radius_px = k == first ? 5.0 : 3.5;
    panel.marks.push_back(std::move(points));
    truths.push_back(std::move(own));
  }
  for (plot::Points& own : truths) panel.marks.push_back(std::move(own));  // above the candidates
  add_boundaries(panel, 1.05 * highest);
  panel.x.range = plot::Range{1.05 * left, 1.2 * right};
  panel.y.range = plot::Range{0.0, 1.05 * highest};
  plot::Figure figure;
  figure.title = std::string("Dynamic stability in ") + (roll ? "roll" : "pitch") +
                 ", candidates of n = " + std::to_string(selection.order) + cell.suffix;
  figure.panel_width = 520.0;
  figure.panel_height = 320.0;
  figure.panels = {std::move(panel)};
  return {(roll ? "Fig. 12" : "Fig. 11") + cell.suffix + ", " + selection.limit_text(),
          "Oscillations of the " + std::to_string(selected.candidates.size()) +
              " candidates (dots) and of the truth (rings) whose peak in the response of the rate to its "
              "control is at least 5 % of "
              "the largest; a vehicle has the level of its worst. Boundaries of ADS-33 from memory, "
              "unverified: level 1 wants a "
              "damping of 0.35 from 0.5 rad/s on and of 0 below, level 2 one of 0 and below 0.5 rad/s no "
              "doubling within 10 s.",
          std::move(figure)};
}

}  // namespace fatmc::candidates
