#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "campaigns/base/prepared_trials.h"
#include "campaigns/candidates/model_analysis.h"
#include "campaigns/candidates/model_table.h"
#include "campaigns/candidates/summary.h"
#include "core/stats/empirical.h"

namespace fatmc::candidates {
namespace {

using Indices = std::vector<std::size_t>;

constexpr std::size_t kMostPoints = 3000;  // of a scatter: every k-th model beyond that

std::vector<double> frequencies() {
  std::vector<double> out;
  for (int k = 0; k < kFrequencies; ++k) out.push_back(frequency_rad_s(k));
  return out;
}

std::vector<double> truth_magnitude(const CandidatesSpec& spec) {
  const auto continuous = continuous_model(spec.truth.model, 1.0 / spec.truth.rate_hz, Continuation::zoh);
  return continuous ? roll_magnitude_db(*continuous) : std::vector<double>{};
}

plot::Panel responses(const std::string& title, const ModelTable& table, const Indices& set,
                      const std::vector<double>& truth) {
  plot::Panel panel;
  panel.title = title;
  panel.x = {"frequency, rad/s", plot::Scale::logarithmic, {}, {}};
  panel.y = {"p/delta_y, dB", plot::Scale::linear, {}, {}};
  std::vector<double> low(kFrequencies, INFINITY), high(kFrequencies, -INFINITY), mean(kFrequencies, 0.0),
      square(kFrequencies, 0.0);
  double n = 0.0;
  for (const std::size_t i : set) {
    if (table.models[i].analysis < 0) continue;
    n += 1.0;
    const auto& db = table.analyses[static_cast<std::size_t>(table.models[i].analysis)].magnitude_db;
    for (std::size_t k = 0; k < db.size(); ++k) {
      low[k] = std::min(low[k], db[k]);
      high[k] = std::max(high[k], db[k]);
      mean[k] += db[k];
      square[k] += db[k] * db[k];
    }
  }
  const std::vector<double> x = frequencies();
  if (n > 0.0) {
    std::vector<double> below, above;
    for (std::size_t k = 0; k < x.size(); ++k) {
      mean[k] /= n;
      const double deviation = std::sqrt(std::max(0.0, square[k] / n - mean[k] * mean[k]));
      below.push_back(mean[k] - deviation);
      above.push_back(mean[k] + deviation);
    }
    panel.marks.push_back(plot::Band{"mean and standard deviation", x, below, above, plot::Hue::grey});
    panel.marks.push_back(plot::Line{"mean", x, mean, plot::Hue::grey, plot::Dash::solid});
    panel.marks.push_back(plot::Line{"smallest and largest", x, low, plot::Hue::grey, plot::Dash::dotted});
    panel.marks.push_back(plot::Line{"smallest and largest", x, high, plot::Hue::grey, plot::Dash::dotted});
  }
  const auto best =
      std::find_if(set.begin(), set.end(), [&](std::size_t i) { return table.models[i].analysis >= 0; });
  if (best != set.end()) {
    const auto& db = table.analyses[static_cast<std::size_t>(table.models[*best].analysis)].magnitude_db;
    panel.marks.push_back(plot::Line{"best by d1", x, db, plot::Hue::red, plot::Dash::solid});
  }
  panel.marks.push_back(plot::Line{"truth", x, truth, plot::Hue::blue, plot::Dash::solid});
  return panel;
}

plot::Points scatter(const std::string& name, const ModelTable& table, const Indices& set, plot::Hue hue,
                     double ModelRow::*y, bool against_rms) {
  plot::Points out;
  out.name = name;
  out.hue = hue;
  out.radius_px = 1.5;
  const std::size_t step = set.size() / kMostPoints + 1;
  for (std::size_t k = 0; k < set.size(); k += step) {
    const ModelRow& model = table.models[set[k]];
    out.x.push_back(against_rms ? model.rms : model.past);
    out.y.push_back(model.*y);
  }
  return out;
}

StudyFigure figure_3(const ModelTable& table, const Selected& selected, const std::string& suffix) {
  plot::Panel panel;
  panel.x = {"J_rms", plot::Scale::logarithmic, {}, {}};
  panel.y = {"overall d1", plot::Scale::linear, {}, {}};
  panel.marks.push_back(scatter("models", table, selected.all, plot::Hue::blue, &ModelRow::agreement, true));
  for (const double limit : {0.8, 0.89, 0.94})
    panel.marks.push_back(
        plot::Rule{"adequate, good, excellent (12)", limit, false, plot::Hue::grey, plot::Dash::dashed});
  panel.marks.push_back(plot::Points{
      "the two models of H Fig. 2, roll rate alone", {0.82, 1.77}, {0.95, 0.91}, plot::Hue::red, false, 3.0});
  plot::Figure figure;
  figure.title = "Index of agreement against rms error" + suffix;
  figure.panels = {std::move(panel)};
  return {"Fig. 3" + suffix,
          "Every model of the first selected order on the eight multisteps, all outputs; J_rms in ft/s, "
          "deg/s, deg.",
          std::move(figure)};
}

StudyFigure figure_4(const ModelTable& table, const std::string& suffix) {
  std::map<int, std::vector<double>> by_order;
  for (const ModelRow& model : table.models) {
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
  panel.marks = {plot::Band{"quartiles", n, lower, upper, plot::Hue::grey},
                 plot::Line{"median", n, median, plot::Hue::blue, plot::Dash::solid},
                 plot::Line{"smallest and largest", n, least, plot::Hue::blue, plot::Dash::dotted},
                 plot::Line{"smallest and largest", n, most, plot::Hue::blue, plot::Dash::dotted}};
  plot::Figure figure;
  figure.title = "Index of agreement by model order" + suffix;
  figure.panels = {std::move(panel)};
  return {"Fig. 4" + suffix, "All models of each order that were identified and validated.",
          std::move(figure)};
}

StudyFigure windows(const ModelTable& table, const Selection& selection, const Selected& selected,
                    const std::string& suffix) {
  plot::Figure figure;
  figure.title =
      "Norm and index of agreement by past window, n = " + std::to_string(selection.order) + suffix;
  figure.columns = 2;
  for (const bool norm : {true, false}) {
    plot::Panel panel;
    panel.x = {"past window p", plot::Scale::linear, {}, {}};
    panel.y = {norm ? "spectral norm of A_K^p" : "overall d1",
               norm ? plot::Scale::logarithmic : plot::Scale::linear,
               {},
               {}};
    double ModelRow::*y = norm ? &ModelRow::norm : &ModelRow::agreement;
    panel.marks.push_back(scatter("all", table, selected.all, plot::Hue::blue, y, false));
    panel.marks.push_back(scatter("best by d1", table, selected.best, plot::Hue::red, y, false));
    panel.marks.push_back(scatter("candidates", table, selected.candidates, plot::Hue::orange, y, false));
    if (norm)
      panel.marks.push_back(plot::Rule{"limit", selected.limit, false, plot::Hue::grey, plot::Dash::dashed});
    figure.panels.push_back(std::move(panel));
  }
  return {"Figs. 6, 7, " + selection.limit_text() + suffix,
          "Every model of the order; of more than 3000 every k-th.", std::move(figure)};
}

/// Tracked modes in the plane of their eigenvalue.
StudyFigure eigenvalues(const ModelTable& table, const Selected& selected, const std::string& suffix) {
  plot::Figure figure;
  figure.title = "Eigenvalues of the candidates" + suffix;
  figure.columns = 2;
  const std::array<std::vector<std::size_t>, 2> axes = {{{0, 1}, {2, 3, 4}}};
  const std::array<plot::Hue, 5> hues = {plot::Hue::grey, plot::Hue::blue, plot::Hue::blue, plot::Hue::orange,
                                         plot::Hue::purple};
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    plot::Panel panel;
    panel.title = axis == 0 ? "pitch" : "roll";
    panel.x = {"real part, 1/s", plot::Scale::linear, {}, {}};
    panel.y = {"imaginary part, rad/s", plot::Scale::linear, {}, {}};
    double highest = 0.0;
    for (const std::size_t mode : axes[axis]) {
      plot::Points points;
      points.name = kTrackedModes[mode].name;
      points.hue = hues[mode];
      for (const std::size_t i : selected.candidates) {
        if (table.models[i].analysis < 0) continue;
        const ModelAnalysisRow& analysis = table.analyses[static_cast<std::size_t>(table.models[i].analysis)];
        if (!(analysis.period_s[mode] > 0.0)) continue;
        const Mode found = mode_of(analysis.period_s[mode], analysis.damping[mode]);
        points.x.push_back(found.s.real());
        points.y.push_back(found.s.imag());
        highest = std::max(highest, found.s.imag());
      }
      panel.marks.push_back(std::move(points));
    }
    const double slope = 0.35 / std::sqrt(1.0 - 0.35 * 0.35);
    panel.marks.push_back(plot::Line{"damping 0.35 (unverified boundary)",
                                     {-0.5 * 0.35, -slope * highest},
                                     {0.5 * std::sqrt(1.0 - 0.35 * 0.35), highest},
                                     plot::Hue::grey,
                                     plot::Dash::dashed});
    panel.marks.push_back(plot::Rule{"", 0.0, true, plot::Hue::grey, plot::Dash::dotted});
    figure.panels.push_back(std::move(panel));
  }
  return {"Figs. 11, 12" + suffix, "Published modes as the candidates of the last selected order have them.",
          std::move(figure)};
}

}  // namespace

Result<std::vector<StudyFigure>> figures(const CampaignSpec& spec, const RowSource& rows) {
  std::vector<StudyFigure> out;
  for (std::uint32_t cell = 0; cell < spec.cells.size(); ++cell) {
    const auto own = spec_of_cell(spec, cell);
    if (!own) return fail(own.error());
    const auto decoded = decode_candidates(*own);
    if (!decoded) return fail(decoded.error());
    const ModelTable table = read_models(cell, rows);
    if (table.models.empty() || decoded->selections.empty()) continue;
    const std::string suffix = spec.cells.size() == 1 ? "" : ", " + spec.cells[cell].name;
    const std::vector<double> truth = truth_magnitude(*decoded);
    const Selection& first = decoded->selections.front();
    const Selected of_first = select(table, first);
    out.push_back(figure_3(table, of_first, suffix));
    out.push_back(figure_4(table, suffix));
    plot::Figure five;
    five.title = "Roll response of the models, n = " + std::to_string(first.order) + suffix;
    five.columns = 2;
    five.panels = {responses("all", table, of_first.all, truth),
                   responses("best by d1", table, of_first.best, truth)};
    out.push_back(
        {"Fig. 5" + suffix, "Magnitude of p/delta_y in deg/s per per cent of control.", std::move(five)});
    for (const Selection& selection : decoded->selections) {
      if (selection.order == first.order)
        out.push_back(windows(table, selection, select(table, selection), suffix));
    }
    plot::Figure eight;
    eight.title = "Roll response of the candidates" + suffix;
    eight.columns = 2;
    for (const Selection& selection : decoded->selections) {
      const Indices candidates = select(table, selection).candidates;
      eight.panels.push_back(responses("n = " + std::to_string(selection.order) + ", " +
                                           selection.limit_text() + (candidates.empty() ? ": none" : ""),
                                       table, candidates, truth));
    }
    out.push_back({"Fig. 8" + suffix, "As Fig. 5, for the candidates.", std::move(eight)});
    const Selection& last = decoded->selections.back();
    out.push_back(eigenvalues(table, select(table, last), suffix + ", " + last.limit_text()));
  }
  return out;
}

}  // namespace fatmc::candidates
