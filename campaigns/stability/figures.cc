#include <algorithm>
#include <cmath>
#include <utility>

#include "campaigns/stability/judged_runs.h"
#include "campaigns/stability/summary.h"

namespace fatmc::stability {
namespace {

using enum Criterion;

std::string what_is_shown(const JudgedRuns& runs) {
  std::string out = std::to_string(runs.runs()) +
                    " runs a box: quartiles and median, whiskers to 1.5 interquartile ranges, dots beyond.";
  if (runs.failed > 0)
    out += " " + std::to_string(runs.failed) + " of them gave no estimate: no value, and p = 0.";
  return out;
}

LineRuns decibels(const LineRuns& ratios) {
  LineRuns out;
  std::vector<double> run_values(ratios.lines());
  for (std::size_t run = 0; run < ratios.runs(); ++run) {
    for (std::size_t k = 0; k < ratios.lines(); ++k)
      run_values[k] = 20.0 * std::log10(std::max(ratios.line(k)[run], 1e-9));
    out.add(run_values);
  }
  return out;
}

plot::Axis frequency_axis() {
  plot::Axis axis;
  axis.label = "Frequency (Hz)";
  axis.scale = plot::Scale::logarithmic;
  return axis;
}

plot::Panel box_panel(const JudgedRuns& runs, const LineRuns& values, std::string title, std::string label,
                      plot::Hue hue) {
  plot::Panel panel;
  panel.title = std::move(title);
  panel.x = frequency_axis();
  panel.y.label = std::move(label);
  plot::Boxes boxes = boxes_of(values, runs.frequency_hz);
  boxes.relative = true;
  boxes.width = 0.012;  // lines are as near as 1.3 % of their frequency
  boxes.hue = hue;
  panel.marks.emplace_back(std::move(boxes));
  return panel;
}

plot::Panel value_panel(const JudgedRuns& runs, const LineRuns& ratios, std::string title, plot::Hue hue) {
  plot::Panel panel = box_panel(runs, decibels(ratios), std::move(title), "Value (dB)", hue);
  // A line, not a rule: it widens the axis to where the limit is.
  panel.marks.emplace_back(plot::Line{"limit of stability",
                                      {runs.frequency_hz.front(), runs.frequency_hz.back()},
                                      {0.0, 0.0},
                                      plot::Hue::grey,
                                      plot::Dash::dashed});
  return panel;
}

plot::Panel confidence_panel(const JudgedRuns& runs, const LineRuns& p, std::string title, plot::Hue hue) {
  plot::Panel panel = box_panel(runs, p, std::move(title), "p", hue);
  panel.y.range = plot::Range{0.0, 1.02};
  return panel;
}

plot::Figure wide(std::vector<plot::Panel> panels) {
  plot::Figure figure;
  figure.panels = std::move(panels);
  figure.panel_width = 720.0;
  figure.panel_height = 230.0;
  return figure;
}

// Shares of the runs in bins of p(B); the last bin holds 1 itself.
plot::Figure histogram(const std::vector<double>& p) {
  constexpr std::size_t kBins = 20;
  plot::Bars bars;
  bars.heights.assign(kBins, 0.0);
  for (std::size_t i = 0; i <= kBins; ++i) bars.edges.push_back(static_cast<double>(i) / kBins);
  for (const double value : p) {
    const auto bin = std::min(kBins - 1, static_cast<std::size_t>(value * kBins));
    bars.heights[bin] += 100.0 / static_cast<double>(p.size());
  }
  plot::Panel panel;
  panel.x.label = "p(B)";
  panel.x.range = plot::Range{0.0, 1.0};
  panel.y.label = "Runs (%)";
  panel.marks.emplace_back(std::move(bars));
  plot::Figure figure;
  figure.panels.push_back(std::move(panel));
  figure.panel_width = 480.0;
  figure.panel_height = 240.0;
  return figure;
}

}  // namespace

Result<std::vector<StudyFigure>> figures(const CampaignSpec& spec, const RowSource& rows) {
  std::vector<StudyFigure> out;
  if (spec.cells.empty()) return out;
  const JudgedRuns runs = judged_runs(0, rows);
  if (runs.runs() == 0) return out;
  const std::string boxes = what_is_shown(runs);
  const std::string reading = " W = sigma + b + intergrid error, b of (2.145), elements combined by min.";
  const auto blue = plot::Hue::blue, orange = plot::Hue::orange;
  const auto add = [&](const char* id, const char* title, std::string caption, plot::Figure figure) {
    figure.title = title;
    out.push_back({id, std::move(caption), std::move(figure)});
  };
  add("Fig. 5-5", "Nominal stability", "The error of the estimate against the nominal model. " + boxes,
      wide({value_panel(runs, runs.array(std::string(kNominalHInfinity)), "H-infinity, nominal", blue),
            value_panel(runs, runs.array(std::string(kNominalSsv)), "ssv, nominal", orange)}));
  add("Fig. 5-6", "Robust stability, H-infinity",
      "Robust stability with an uncertainty of one standard deviation, H-infinity." + reading + " " + boxes,
      wide({value_panel(runs, runs.value(kMain, h_infinity), "H-infinity", blue)}));
  add("Fig. 5-7", "Robust stability, structured singular value",
      "The same by structured singular values, upper bound. " + boxes,
      wide({value_panel(runs, runs.value(kMain, ssv), "ssv", orange)}));
  add("Fig. 5-8", "Confidence of a line, H-infinity",
      "Confidence in robust stability from H-infinity." + reading + " " + boxes,
      wide({confidence_panel(runs, runs.confidence(kMain, h_infinity, Rule::min), "p, H-infinity", blue)}));
  add("Fig. 5-9", "Confidence of a line, structured singular value",
      "Confidence in robust stability from ssv. " + boxes,
      wide({confidence_panel(runs, runs.confidence(kMain, ssv, Rule::min), "p, ssv", orange)}));
  const std::string n = std::to_string(runs.runs()) + " runs.";
  add("Fig. 5-10", "Confidence over the band",
      "Confidence over the whole band from ssv, lines taken as independent. " + n,
      histogram(runs.band(kMain, ssv, Rule::min)));
  add("Fig. 5-11", "Total confidence of a line, H-infinity",
      "Total confidence from H-infinity: zero where nominal stability or the input SNR fails. " + boxes,
      wide({confidence_panel(runs, runs.total(kMain, h_infinity, Rule::min), "total p, H-infinity", blue)}));
  add("Fig. 5-12", "Total confidence of a line, structured singular value",
      "Total confidence from ssv. " + boxes,
      wide({confidence_panel(runs, runs.total(kMain, ssv, Rule::min), "total p, ssv", orange)}));
  add("Fig. 5-13", "Total confidence over the band", "Total confidence over the whole band from ssv. " + n,
      histogram(runs.total_band(kMain, ssv, Rule::min)));
  return out;
}

}  // namespace fatmc::stability
