// Figs. 2, 9 and 10: time histories.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "campaigns/candidates/model_analysis.h"
#include "campaigns/candidates/study_figures.h"
#include "core/accuracy/series_accuracy.h"
#include "core/base/text.h"
#include "core/handling/control_loop.h"
#include "core/subspace/model_fit.h"

namespace fatmc::candidates {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kPrintedGap = kRollModels[0].agreement - kRollModels[1].agreement;

/// Of those analysed, the model whose d1 of the roll rate is nearest to `wanted`.
std::optional<std::size_t> nearest_roll(const ModelTable& table, const std::vector<std::size_t>& set,
                                        double wanted) {
  std::optional<std::size_t> best;
  for (const std::size_t i : set) {
    if (table.analysis_of(i) == nullptr) continue;
    const auto distance = [&](std::size_t m) { return std::abs(table.models[m].roll_agreement - wanted); };
    if (!best || distance(i) < distance(*best)) best = i;
  }
  return best;
}

std::vector<double> column(const Eigen::Ref<const Eigen::VectorXd>& values) {
  return {values.data(), values.data() + values.size()};
}

void add_simulated(plot::Panel& panel, const CellData& cell, std::size_t model, const std::string& name,
                   plot::Hue hue, const std::vector<double>& time) {
  const Maneuver& maneuver = cell.flown.multisteps[kRollManeuver];
  const auto fit = fit_maneuver(cell.table.analysis_of(model)->model, maneuver);
  if (!fit) return;
  const std::vector<double> roll = column(fit->outputs.col(kRollRate) * kDegrees),
                            measured = column(maneuver.outputs.col(kRollRate) * kDegrees);
  const ModelRow& row = cell.table.models[model];
  const auto theil = theil_coefficient(measured, roll);
  panel.marks.push_back(plot::Line{name + ": J_rms " + significant(row.roll_rms, 3) + " deg/s, d1 " +
                                       significant(row.roll_agreement, 3) + " (" +
                                       std::string(agreement_rating(row.roll_agreement)) + "), Theil " +
                                       (theil ? significant(*theil, 2) : "-"),
                                   time, roll, hue, plot::Dash::solid});
}

/// Smallest, largest and mean response over the candidates.
void add_impulses(plot::Panel& panel, const CellData& cell, const std::vector<std::size_t>& set,
                  const JudgedResponse& judged, plot::Hue hue, const std::vector<double>& time) {
  std::vector<double> low(time.size(), INFINITY), high(time.size(), -INFINITY), mean(time.size(), 0.0);
  double n = 0.0;
  const auto response = [&](const DiscreteModel& model) -> std::vector<double> {
    const std::vector<ContinuousModel> vehicles = vehicles_of(model, cell.spec.truth.rate_hz);
    if (vehicles.empty()) return {};
    const auto found = impulse_response(vehicles[static_cast<std::size_t>(judged.vehicle)], judged.output,
                                        judged.input, time);
    return found ? *found : std::vector<double>{};
  };
  for (const std::size_t i : set) {
    const ModelAnalysisRow* analysis = cell.table.analysis_of(i);
    if (analysis == nullptr) continue;
    const std::vector<double> y = response(analysis->model.model);
    if (y.empty()) continue;
    n += 1.0;
    for (std::size_t k = 0; k < y.size(); ++k) {
      low[k] = std::min(low[k], kDegrees * y[k]);
      high[k] = std::max(high[k], kDegrees * y[k]);
      mean[k] += kDegrees * y[k];
    }
  }
  const std::string name = judged.name;
  if (n > 0.0) {
    for (double& value : mean) value /= n;
    panel.marks.push_back(plot::Band{name + ": candidates", time, low, high, hue});
    panel.marks.push_back(plot::Line{name + ": mean", time, mean, hue, plot::Dash::solid});
  }
  std::vector<double> truth = response(cell.spec.truth.model);
  for (double& value : truth) value *= kDegrees;
  if (!truth.empty())
    panel.marks.push_back(plot::Line{name + ": truth", time, truth, hue, plot::Dash::dotted});
}

}  // namespace

std::vector<ContinuousModel> vehicles_of(const DiscreteModel& model, double rate_hz) {
  const auto bare = continuous_model(model, 1.0 / rate_hz, Continuation::zoh);
  if (!bare) return {};
  return {*bare, stabilized_vehicle(*bare), optimized_vehicle(*bare)};
}

StudyFigure roll_history_figure(const CellData& cell, const Selected& selected, int order) {
  plot::Figure figure;
  figure.title = "Roll rate of two models and measured, n = " + std::to_string(order) + cell.suffix;
  figure.panel_width = 680.0;
  plot::Panel panel;
  panel.x = {"time, s", plot::Scale::linear, {}, {}};
  panel.y = {"roll rate, deg/s", plot::Scale::linear, {}, {}};
  if (cell.flown.multisteps.size() > kRollManeuver) {
    const Maneuver& maneuver = cell.flown.multisteps[kRollManeuver];
    std::vector<double> time;
    for (Eigen::Index t = 0; t < maneuver.samples(); ++t)
      time.push_back(static_cast<double>(t) / cell.spec.truth.rate_hz);
    panel.marks.push_back(plot::Line{"measured", time, column(maneuver.outputs.col(kRollRate) * kDegrees),
                                     plot::Hue::grey, plot::Dash::solid});
    const auto good = nearest_roll(cell.table, selected.all, 1.0);
    if (good) {
      add_simulated(panel, cell, *good, "model 1", plot::Hue::blue, time);
      const auto other =
          nearest_roll(cell.table, selected.all, cell.table.models[*good].roll_agreement - kPrintedGap);
      if (other && *other != *good) add_simulated(panel, cell, *other, "model 2", plot::Hue::red, time);
    }
  }
  figure.panels = {std::move(panel)};
  return {"Fig. 2" + cell.suffix,
          "First multistep of the lateral control. Model 1: the best by d1 of this roll rate; model 2: that "
          "whose d1 is nearest to 0.04 below, the distance of the two models of H (J_rms 0.82 deg/s, d1 "
          "0.95; 1.77 "
          "deg/s, 0.91).",
          std::move(figure)};
}

StudyFigure impulse_figure(const CellData& cell, const Selection& selection, const Selected& selected,
                           bool roll) {
  const double length_s = roll ? 3.0 : 20.0;
  std::vector<double> time;
  for (int k = 0; k <= 240; ++k) time.push_back(length_s * k / 240.0);
  plot::Figure figure;
  figure.title = std::string(roll ? "Roll" : "Pitch") +
                 " rate after an impulse, candidates of n = " + std::to_string(selection.order) + cell.suffix;
  figure.panel_width = 680.0;
  figure.panel_height = 240.0;
  plot::Panel panel;
  panel.x = {"time, s", plot::Scale::linear, {}, {}};
  panel.y = {
      roll ? "p, deg/s per % s of delta_y" : "q, deg/s per % s of delta_x", plot::Scale::linear, {}, {}};
  const std::size_t first = roll ? 2 : 0;
  add_impulses(panel, cell, selected.candidates, kJudged[first], roll ? plot::Hue::blue : plot::Hue::grey,
               time);
  add_impulses(panel, cell, selected.candidates, kJudged[first + 1],
               roll ? plot::Hue::orange : plot::Hue::blue, time);
  figure.panels = {std::move(panel)};
  return {(roll ? "Fig. 10" : "Fig. 9") + cell.suffix + ", " + selection.limit_text(),
          "Response to an impulse of 1 % s on the control: area from the smallest to the largest of the " +
              std::to_string(selected.candidates.size()) +
              " candidates, their mean, and the truth. The truth's rate begins at 0, since the rotor flaps "
              "first; an "
              "identified model may begin with a step.",
          std::move(figure)};
}

}  // namespace fatmc::candidates
