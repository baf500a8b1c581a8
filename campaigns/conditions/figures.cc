#include <algorithm>
#include <cmath>
#include <set>

#include "campaigns/conditions/condition_runs.h"
#include "campaigns/conditions/summary.h"
#include "core/base/text.h"

namespace fatmc::conditions {
namespace {

constexpr std::array kHues = {plot::Hue::blue, plot::Hue::orange, plot::Hue::green, plot::Hue::purple};

std::string series_name(const Condition& condition) {
  return condition.grade + " gyros, gain " + shortest(condition.gain);
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Error of the three primary elements against turbulence, a curve for each grade and gain.
StudyFigure error_by_turbulence(const std::vector<ConditionRuns>& cells) {
  StudyFigure out{
      "Conditions",
      "rms over the lines of |Ĝ − G0|/|G0|, mean over the runs that gave an estimate, against the standard "
      "deviation of the gusts. The experiment is chapter 5's.",
      {}};
  out.figure.title = "Error of the fast LPM under other conditions";
  out.figure.columns = 3;
  std::vector<std::string> series;
  for (const ConditionRuns& cell : cells) {
    const std::string name = series_name(cell.condition);
    if (std::find(series.begin(), series.end(), name) == series.end()) series.push_back(name);
  }
  for (std::size_t e = 0; e < 3; ++e) {
    plot::Panel panel;
    panel.title = std::string(kElements[e].label);
    panel.x = {"gusts, m/s", plot::Scale::logarithmic, {}, {0.5, 1.5, 3.0, 4.4}};
    panel.y = {e == 0 ? "error, %" : "", plot::Scale::logarithmic, {}, {}};
    for (std::size_t s = 0; s < series.size(); ++s) {
      plot::Line line{series[s],
                      {},
                      {},
                      kHues[s % kHues.size()],
                      s < kHues.size() ? plot::Dash::solid : plot::Dash::dashed};
      for (const ConditionRuns& cell : cells) {
        if (series_name(cell.condition) != series[s] || cell.relative_error[e].empty()) continue;
        line.x.push_back(cell.condition.turbulence_m_s);
        line.y.push_back(100.0 * mean_of(cell.relative_error[e]));
      }
      plot::Points dots{series[s], line.x, line.y, line.hue};
      panel.marks.emplace_back(std::move(line));
      panel.marks.emplace_back(std::move(dots));
    }
    out.figure.panels.push_back(std::move(panel));
  }
  return out;
}

/// |mean error| of r/ξ_c with the noise that its mean still has, line by line.
StudyFigure coordinator_figure(const std::vector<ConditionRuns>& cells) {
  constexpr std::size_t kYawByRoll = 3;
  static_assert(kElements[kYawByRoll].key == "r_xi");
  StudyFigure out{"Section A.6",
                  "|mean over runs of (Ĝ − G0)/G0| of r/ξ_c with and without turn coordinator, estimated by "
                  "the fast LPM from "
                  "the same reference levels; dotted: standard error of that mean. G0 is the plant's "
                  "response, in which the "
                  "turn coordinator does not occur.",
                  {}};
  out.figure.title = "Estimate of r/ξ_c with and without turn coordinator";
  std::set<double> gains;
  for (const ConditionRuns& cell : cells) gains.insert(cell.condition.gain);
  out.figure.columns = static_cast<int>(gains.size());
  for (const double gain : gains) {
    plot::Panel panel;
    panel.title = "gain " + shortest(gain) + " s/rad";
    panel.x = {"f, Hz", plot::Scale::logarithmic, {}, {}};
    panel.y = {"error, %", plot::Scale::logarithmic, {}, {}};
    for (const ConditionRuns& cell : cells) {
      if (cell.condition.gain != gain || cell.trials == cell.failed) continue;
      const plot::Hue hue = cell.condition.turn_coordinator ? plot::Hue::purple : plot::Hue::blue;
      plot::Line error{cell.condition.turn_coordinator ? "with" : "without", cell.frequency_hz, {}, hue};
      plot::Line noise{"", cell.frequency_hz, {}, hue, plot::Dash::dotted};
      const double runs = static_cast<double>(cell.trials - cell.failed);
      for (std::size_t k = 0; k < cell.frequency_hz.size(); ++k) {
        error.y.push_back(100.0 * std::abs(cell.mean_error[kYawByRoll][k]));
        noise.y.push_back(100.0 * cell.deviation[kYawByRoll][k] / std::sqrt(runs));
      }
      panel.marks.emplace_back(std::move(noise));
      panel.marks.emplace_back(std::move(error));
    }
    out.figure.panels.push_back(std::move(panel));
  }
  return out;
}

}  // namespace

Result<std::vector<StudyFigure>> figures(const CampaignSpec& spec, const RowSource& rows) {
  const auto cells = collect(spec, rows);
  if (!cells) return fail(cells.error());
  std::set<double> turbulence;
  std::set<bool> coordinator;
  for (const ConditionRuns& cell : *cells) {
    turbulence.insert(cell.condition.turbulence_m_s);
    coordinator.insert(cell.condition.turn_coordinator);
  }
  std::vector<StudyFigure> out;
  if (turbulence.size() > 1) out.push_back(error_by_turbulence(*cells));
  if (coordinator.size() > 1) out.push_back(coordinator_figure(*cells));
  return out;
}

}  // namespace fatmc::conditions
