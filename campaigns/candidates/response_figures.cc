// Figs. 5 and 8: p/delta_y of the models beside the truth and what the sweeps measure.
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>

#include "campaigns/candidates/model_analysis.h"
#include "campaigns/candidates/study_figures.h"
#include "core/handling/control_loop.h"
#include "core/ident/estimators.h"

namespace fatmc::candidates {
namespace {

using Indices = std::vector<std::size_t>;

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// Four to a frequency of the study: resonances and zeros of a single curve are narrower than its grid.
std::vector<double> fine_frequencies() {
  std::vector<double> out;
  const std::vector<double>& coarse = study_frequencies();
  for (std::size_t k = 0; k + 1 < coarse.size(); ++k) {
    for (int i = 0; i < 4; ++i) out.push_back(coarse[k] * std::pow(coarse[k + 1] / coarse[k], 0.25 * i));
  }
  out.push_back(coarse.back());
  return out;
}

plot::Line response(const std::string& name, const CandidatesSpec& spec, const DiscreteModel& model,
                    plot::Hue hue, plot::Dash dash) {
  const auto continuous = continuous_model(model, 1.0 / spec.truth.rate_hz, Continuation::zoh);
  if (!continuous) return {name, {}, {}, hue, dash};
  std::vector<double> w = fine_frequencies(), db = roll_magnitude_db(*continuous, w);
  return {name, std::move(w), std::move(db), hue, dash};
}

/// Mean, standard deviation and extremes of a set, in dB.
void add_spread(plot::Panel& panel, const ModelTable& table, const Indices& set) {
  std::vector<double> low(kFrequencies, INFINITY), high(kFrequencies, -INFINITY), mean(kFrequencies, 0.0),
      square(kFrequencies, 0.0);
  double n = 0.0;
  for (const std::size_t i : set) {
    const ModelAnalysisRow* analysis = table.analysis_of(i);
    if (analysis == nullptr) continue;
    n += 1.0;
    for (std::size_t k = 0; k < analysis->magnitude_db.size(); ++k) {
      const double db = analysis->magnitude_db[k];
      low[k] = std::min(low[k], db);
      high[k] = std::max(high[k], db);
      mean[k] += db;
      square[k] += db * db;
    }
  }
  if (n == 0.0) return;
  const std::vector<double>& x = study_frequencies();
  std::vector<double> below, above;
  for (std::size_t k = 0; k < x.size(); ++k) {
    mean[k] /= n;
    const double deviation = std::sqrt(std::max(0.0, square[k] / n - mean[k] * mean[k]));
    below.push_back(mean[k] - deviation);
    above.push_back(mean[k] + deviation);
  }
  panel.marks.push_back(plot::Band{"mean +- standard deviation", x, below, above, plot::Hue::grey});
  panel.marks.push_back(plot::Line{"mean", x, mean, plot::Hue::grey, plot::Dash::solid});
  panel.marks.push_back(plot::Line{"smallest and largest", x, low, plot::Hue::grey, plot::Dash::dotted});
  panel.marks.push_back(plot::Line{"smallest and largest", x, high, plot::Hue::grey, plot::Dash::dotted});
}

plot::Panel responses(const std::string& title, const CellData& cell, const Indices& set,
                      const std::optional<MeasuredResponse>& measured) {
  plot::Panel panel;
  panel.title = title;
  panel.x = {"frequency, rad/s", plot::Scale::logarithmic, {}, {}};
  panel.y = {"p/delta_y, dB", plot::Scale::linear, {}, {}};
  add_spread(panel, cell.table, set);
  const auto best = std::find_if(set.begin(), set.end(),
                                 [&](std::size_t i) { return cell.table.analysis_of(i) != nullptr; });
  if (best != set.end())
    panel.marks.push_back(response("best by d1", cell.spec, cell.table.analysis_of(*best)->model.model,
                                   plot::Hue::red, plot::Dash::solid));
  if (measured) {
    panel.marks.push_back(plot::Line{"measured", measured->frequency_rad_s, measured->decibel,
                                     plot::Hue::orange, plot::Dash::solid});
  }
  panel.marks.push_back(
      response("truth", cell.spec, cell.spec.truth.model, plot::Hue::blue, plot::Dash::dashed));
  return panel;
}

constexpr const char* kCaption =
    "Magnitude of p/delta_y in deg/s per per cent of control. Measured: estimated from the eight sweeps "
    "together, as fatmc estimate --method arbitrary does, within the band of the sweeps. Mean and standard "
    "deviation over the "
    "models, of decibels.";

}  // namespace

std::optional<MeasuredResponse> measured_response(const CandidatesSpec& spec, const FlownTest& flown) {
  std::vector<Measurement> measurements;
  for (const Maneuver& sweep : flown.sweeps) {
    Measurement m;
    m.experiment.rate_hz = spec.truth.rate_hz;
    m.outputs = sweep.outputs.col(kRollRate);
    m.inputs = sweep.inputs;
    m.low_hz = spec.flight.sweep_low_hz;
    m.high_hz = 1.5 * spec.flight.sweep_high_hz;  // the pilot's frequency wanders
    m.references.resize(sweep.samples(), 0);
    measurements.push_back(std::move(m));
  }
  const auto estimate = estimate_response(EstimationMethod::arbitrary, measurements, {});
  if (!estimate) return std::nullopt;
  MeasuredResponse out;
  for (int k = 0; k < estimate->frm.line_count(); ++k) {
    const auto line = static_cast<std::size_t>(k);
    if (estimate->frm.status[line] != LineStatus::ok) continue;
    out.frequency_rad_s.push_back(2.0 * std::numbers::pi * estimate->frm.frequency_hz[line]);
    out.decibel.push_back(20.0 * std::log10(kDegrees * std::abs(estimate->frm.G[k](0, kLateralInput))));
  }
  return out;
}

StudyFigure best_response_figure(const CellData& cell, const Selected& selected, int order,
                                 const std::optional<MeasuredResponse>& measured) {
  plot::Figure figure;
  figure.title = "Roll response of the models, n = " + std::to_string(order) + cell.suffix;
  figure.columns = 2;
  figure.panels = {responses("all", cell, selected.all, measured),
                   responses("best by d1", cell, selected.best, measured)};
  return {"Fig. 5" + cell.suffix, kCaption, std::move(figure)};
}

StudyFigure candidate_response_figure(const CellData& cell, const std::optional<MeasuredResponse>& measured) {
  plot::Figure figure;
  figure.title = "Roll response of the candidates" + cell.suffix;
  figure.columns = 2;
  for (const Selection& selection : cell.spec.selections) {
    const Indices candidates = select(cell.table, selection).candidates;
    figure.panels.push_back(responses("n = " + std::to_string(selection.order) + ", " +
                                          selection.limit_text() + (candidates.empty() ? ": none" : ""),
                                      cell, candidates, measured));
  }
  return {"Fig. 8" + cell.suffix, kCaption, std::move(figure)};
}

}  // namespace fatmc::candidates
