// Figs. 3, 4, 6 and 7: accuracy of the models by rms error, order and past window.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "campaigns/candidates/model_analysis.h"
#include "campaigns/candidates/study_figures.h"
#include "core/base/text.h"
#include "core/stats/empirical.h"

namespace fatmc::candidates {
namespace {

using Indices = std::vector<std::size_t>;

constexpr std::size_t kMostPoints = 3000;  // of a scatter: every k-th model beyond that

plot::Points scatter(const std::string& name, const ModelTable& table, const Indices& set, plot::Hue hue,
                     const auto& x, const auto& y) {
  plot::Points out;
  out.name = name;
  out.hue = hue;
  out.radius_px = 1.5;
  const std::size_t step = set.size() / kMostPoints + 1;
  for (std::size_t k = 0; k < set.size(); k += step) {
    out.x.push_back(x(table.models[set[k]]));
    out.y.push_back(y(table.models[set[k]]));
  }
  return out;
}

/// The rating (12), within the panel whatever the models reach.
void add_ratings(plot::Panel& panel, double lowest) {
  for (const double limit : {0.8, 0.89, 0.94})
    panel.marks.push_back(plot::Rule{"d1 from 0.80 adequate, 0.89 good, 0.94 excellent (12)", limit, false,
                                     plot::Hue::grey, plot::Dash::dashed});
  panel.y.range = plot::Range{std::min(lowest, 0.78) - 0.02, 1.0};
}

double lowest_of(const ModelTable& table, const Indices& set, const auto& value) {
  double out = 1.0;
  for (const std::size_t i : set) out = std::min(out, value(table.models[i]));
  return out;
}

/// d1 of a series that is right but for its size, (1 + a) m, against its rms error |a| rms(m): two branches,
/// the smaller series having the lower d1. Means are left aside.
void add_size_curves(plot::Panel& panel, const Eigen::VectorXd& measured) {
  const double rms = std::sqrt((measured.array() - measured.mean()).square().mean());
  for (const bool larger : {true, false}) {
    std::vector<double> x, y;
    for (int k = 1; k <= 40; ++k) {
      const double a = 0.02 * k;
      x.push_back(a * rms);
      y.push_back(larger ? 1.0 - a / (2.0 + a) : 1.0 - a / (2.0 - a));
    }
    panel.marks.push_back(plot::Line{larger ? "right but too large" : "right but too small", x, y,
                                     plot::Hue::green, larger ? plot::Dash::solid : plot::Dash::dotted});
  }
}

}  // namespace

StudyFigure accuracy_figure(const CellData& cell, const Selected& selected, int order) {
  plot::Panel roll, all;
  roll.title = "roll rate of one multistep";
  roll.x = {"J_rms, deg/s", plot::Scale::logarithmic, {}, {}};
  roll.y = {"d1", plot::Scale::linear, {}, {}};
  roll.marks.push_back(scatter(
      "models", cell.table, selected.all, plot::Hue::blue, [](const ModelRow& m) { return m.roll_rms; },
      [](const ModelRow& m) { return m.roll_agreement; }));
  constexpr double degrees = 57.29577951308232;
  if (cell.flown.multisteps.size() > kRollManeuver)
    add_size_curves(roll, cell.flown.multisteps[kRollManeuver].outputs.col(kRollRate) * degrees);
  roll.marks.push_back(plot::Points{"the two models of H",
                                    {kRollModels[0].rms_deg_s, kRollModels[1].rms_deg_s},
                                    {kRollModels[0].agreement, kRollModels[1].agreement},
                                    plot::Hue::red,
                                    false,
                                    3.0});
  add_ratings(roll, lowest_of(cell.table, selected.all, [](const ModelRow& m) { return m.roll_agreement; }));
  all.title = "all outputs, all multisteps";
  all.x = {"J_rms, ft/s, deg/s, deg", plot::Scale::logarithmic, {}, {}};
  all.y = {"overall d1", plot::Scale::linear, {}, {}};
  all.marks.push_back(scatter(
      "models", cell.table, selected.all, plot::Hue::blue, [](const ModelRow& m) { return m.rms; },
      [](const ModelRow& m) { return m.agreement; }));
  add_ratings(all, lowest_of(cell.table, selected.all, [](const ModelRow& m) { return m.agreement; }));
  double largest = 3.5;
  for (const std::size_t i : selected.all) largest = std::max(largest, cell.table.models[i].rms);
  all.x.range = plot::Range{0.5, 1.1 * largest};
  for (const double limit : {1.0, 2.0, 3.5})
    all.marks.push_back(plot::Rule{"J_rms below 1 excellent, 2 good, 3.5 adequate (9)", limit, true,
                                   plot::Hue::purple, plot::Dash::dotted});
  plot::Figure figure;
  figure.title = "Index of agreement against rms error, n = " + std::to_string(order) + cell.suffix;
  figure.columns = 2;
  figure.panels = {std::move(roll), std::move(all)};
  return {"Fig. 3" + cell.suffix,
          "Every model of the order, thinned evenly beyond " + std::to_string(kMostPoints) +
              ". Green: a roll rate that is right but for its size. H's two models "
              "repeat another "
              "record: an rms error scales with the record, d1 does not.",
          std::move(figure)};
}

StudyFigure order_figure(const CellData& cell) {
  std::map<int, std::vector<double>> by_order;
  for (const ModelRow& model : cell.table.models) {
    if (model.state == ModelState::ok) by_order[model.order].push_back(model.agreement);
  }
  std::vector<double> n, least, lower, median, upper, most;
  for (const auto& [order, values] : by_order) {
    const EmpiricalCdf cdf(values);
    n.push_back(order);
    least.push_back(cdf.quantile(0.0));
    lower.push_back(cdf.quantile(0.25));
    median.push_back(cdf.quantile(0.5));
    upper.push_back(cdf.quantile(0.75));
    most.push_back(cdf.quantile(1.0));
  }
  plot::Panel panel;
  panel.x = {"model order n", plot::Scale::linear, {}, {}};
  panel.y = {"overall d1", plot::Scale::linear, {}, {}};
  panel.x.ticks = n;
  panel.marks = {plot::Band{"lower to upper quartile", n, lower, upper, plot::Hue::grey},
                 plot::Line{"median", n, median, plot::Hue::blue, plot::Dash::solid},
                 plot::Line{"smallest and largest", n, least, plot::Hue::blue, plot::Dash::dotted},
                 plot::Line{"smallest and largest", n, most, plot::Hue::blue, plot::Dash::dotted},
                 plot::Rule{"adequate from 0.80 (12)", 0.8, false, plot::Hue::grey, plot::Dash::dashed}};
  plot::Figure figure;
  figure.title = "Index of agreement by model order" + cell.suffix;
  figure.panel_width = 520.0;
  figure.panel_height = 240.0;
  figure.panels = {std::move(panel)};
  return {"Fig. 4" + cell.suffix, "All models of each order that were identified and validated.",
          std::move(figure)};
}

StudyFigure window_figure(const CellData& cell, const Selection& selection, const Selected& selected) {
  plot::Figure figure;
  figure.title =
      "Norm and index of agreement by past window, n = " + std::to_string(selection.order) + cell.suffix;
  figure.columns = 2;
  const auto past = [](const ModelRow& m) { return static_cast<double>(m.past); };
  double longest = 0.0, smallest_norm = selected.limit > 0.0 ? selected.limit : 1.0;
  for (const std::size_t i : selected.all) {
    const ModelRow& model = cell.table.models[i];
    longest = std::max(longest, past(model));
    if (model.norm > 0.0) smallest_norm = std::min(smallest_norm, model.norm);
  }
  for (const bool norm : {true, false}) {
    plot::Panel panel;
    panel.x = {"past window p", plot::Scale::linear, plot::Range{0.0, 1.03 * longest}, {}};
    panel.title =
        norm ? "spectral norm of A_K^p" : "overall d1";  // beside the axis it would run into small norms
    panel.y = {"", norm ? plot::Scale::logarithmic : plot::Scale::linear, {}, {}};
    const auto y = [norm](const ModelRow& m) { return norm ? m.norm : m.agreement; };
    panel.marks.push_back(scatter("all", cell.table, selected.all, plot::Hue::blue, past, y));
    panel.marks.push_back(scatter("best by d1", cell.table, selected.best, plot::Hue::red, past, y));
    panel.marks.push_back(scatter("candidates", cell.table, selected.candidates, plot::Hue::orange, past, y));
    if (norm) {
      panel.y.range = plot::Range{std::max(0.5 * smallest_norm, 1e-30), 3.0};
      panel.marks.push_back(plot::Rule{"limit of the norm: " + significant(selected.limit, 2), selected.limit,
                                       false, plot::Hue::grey, plot::Dash::dashed});
    }
    figure.panels.push_back(std::move(panel));
  }
  const auto count = [](const Indices& set) { return std::to_string(set.size()); };
  return {"Figs. 6, 7, n = " + std::to_string(selection.order) + ", " + selection.limit_text() + cell.suffix,
          "Every model of the order (" + count(selected.all) + "; a set of more than " +
              std::to_string(kMostPoints) + " is thinned evenly), the best " + count(selected.best) +
              " by d1 alone, and the candidates: of the " + count(selected.accepted) +
              " models below the limit the best by d1, " + count(selected.candidates) +
              " of them. Later sets cover earlier ones.",
          std::move(figure)};
}

}  // namespace fatmc::candidates
