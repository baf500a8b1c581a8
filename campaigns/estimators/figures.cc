// Figs. 3-10 to 3-15: errors of the magnitude at every line, run by run, with their mean.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "campaigns/estimators/cell_runs.h"
#include "campaigns/estimators/mean_error.h"
#include "campaigns/estimators/summary.h"
#include "campaigns/estimators/user_choices_figure.h"
#include "core/accuracy/response_accuracy.h"
#include "core/base/text.h"

namespace fatmc::estimators {
namespace {

// T's three; the indirect fast LPM stands in the tables.
constexpr std::array kDrawn = {0, 1, 2};
constexpr std::array kHues = {plot::Hue::blue, plot::Hue::orange, plot::Hue::green};

/// Estimators stand side by side at a line, 0.012 Hz apart.
double place(double frequency_hz, std::size_t estimator) {
  return frequency_hz + 0.012 * (static_cast<double>(estimator) - 1.0);
}

std::vector<std::size_t> first_runs(const EstimatorRuns& runs) {
  std::vector<std::size_t> out(std::min(runs.error.size(), kPublishedRepetitions));
  std::iota(out.begin(), out.end(), std::size_t{0});
  return out;
}

/// Runs as dots, their mean as a ring with its 90 % interval as a bar.
void add_scatter(const CellRuns& cell, std::size_t e, plot::Panel& panel) {
  const EstimatorRuns& runs = cell.of[e];
  const std::vector<std::size_t> picks = first_runs(runs);
  const std::string label(kEstimators[e].label);
  plot::Points dots{label, {}, {}, kHues[e], true, 1.2}, means{"", {}, {}, kHues[e], false, 3.0};
  plot::Line bars{"", {}, {}, kHues[e], plot::Dash::solid};
  for (std::size_t k = 0; k < cell.frequency_hz.size(); ++k) {
    const double x = place(cell.frequency_hz[k], e);
    const ErrorOfRun error = [&](std::size_t run) { return runs.magnitude_error(run, k); };
    for (const std::size_t run : picks) {
      dots.x.push_back(x);
      dots.y.push_back(100.0 * error(run));
    }
    const double mean = mean_of(picks, error).mean, range = range_of_mean(picks, error, picks.size());
    means.x.push_back(x);
    means.y.push_back(100.0 * mean);
    for (const double y : {mean - range, mean + range, std::numeric_limits<double>::quiet_NaN()}) {
      bars.x.push_back(x);
      bars.y.push_back(100.0 * y);
    }
  }
  panel.marks.emplace_back(std::move(dots));
  panel.marks.emplace_back(std::move(bars));
  panel.marks.emplace_back(std::move(means));
}

void add_decibel(const CellRuns& cell, std::size_t e, plot::Panel& panel) {
  const EstimatorRuns& runs = cell.of[e];
  plot::Points dots{std::string(kEstimators[e].label), {}, {}, kHues[e], true, 1.5};
  for (const std::size_t run : first_runs(runs)) {
    for (std::size_t k = 0; k < cell.frequency_hz.size(); ++k) {
      dots.x.push_back(place(cell.frequency_hz[k], e));
      dots.y.push_back(runs.magnitude_error_db(run, k));
    }
  }
  panel.marks.emplace_back(std::move(dots));
}

void add_muad(const CellRuns& cell, plot::Panel& panel) {
  plot::Line upper{"MUAD limits (unverified)", {}, {}, plot::Hue::grey, plot::Dash::dashed}, lower = upper;
  lower.name.clear();
  const double low = cell.frequency_hz.front(), high = cell.frequency_hz.back();
  for (int i = 0; i <= 100; ++i) {
    const double f = low + (high - low) * i / 100.0;
    const UnnoticedDynamics limits = unnoticed_dynamics(f);
    upper.x.push_back(f);
    upper.y.push_back(limits.upper_db);
    lower.x.push_back(f);
    lower.y.push_back(limits.lower_db);
  }
  panel.marks.emplace_back(std::move(upper));
  panel.marks.emplace_back(std::move(lower));
}

StudyFigure figure_of(const CellRuns& cell, const std::string& id, bool decibel) {
  StudyFigure out;
  out.id = id;
  const std::string runs = std::to_string(first_runs(cell.of[0]).size());
  const std::string condition = cell.name.empty() ? "linear" : cell.name;
  plot::Panel panel;
  panel.x.label = "f, Hz";
  panel.x.range = plot::Range{cell.frequency_hz.front() - 0.03, cell.frequency_hz.back() + 0.03};
  panel.y.label = decibel ? "error of the magnitude, dB" : "error of the magnitude, %";
  for (const std::size_t e : kDrawn) decibel ? add_decibel(cell, e, panel) : add_scatter(cell, e, panel);
  if (decibel) {
    add_muad(cell, panel);
    out.caption =
        "The same errors in dB, between the limits of unnoticed additional dynamics; constants of the limits "
        "are "
        "quoted from MIL-HDBK-1797 from memory.";
  } else {
    panel.marks.emplace_back(plot::Rule{"", 0.0});
    out.caption =
        "(|Ĝ| − |G0|)/|G0| of " + runs + " runs, " + condition +
        "; rings: mean, bars: its 90 % interval (Student's t). Estimators stand side by side at each line.";
  }
  out.figure.title =
      std::string(decibel ? "Error of the magnitude in dB, " : "Relative error of the magnitude, ") +
      condition;
  out.figure.panel_width = 720.0;
  out.figure.panel_height = 320.0;
  out.figure.panels.push_back(std::move(panel));
  return out;
}

}  // namespace

Result<std::vector<StudyFigure>> figures(const CampaignSpec& spec, const RowSource& rows) {
  static constexpr std::array kPairs = {std::pair{"Fig. 3-10", "Fig. 3-11"},
                                        std::pair{"Fig. 3-12", "Fig. 3-13"},
                                        std::pair{"Fig. 3-14", "Fig. 3-15"}};
  std::vector<StudyFigure> out;
  UserChoices choices;
  for (std::uint32_t index = 0; index < spec.cells.size(); ++index) {
    const auto cell = collect_cell(spec, index, rows);
    if (!cell) return fail(cell.error());
    if (cell->trials == cell->failed) continue;
    for (const auto& [plain, decibel] : kPairs) {
      if (cell->shown_in(plain)) out.push_back(figure_of(*cell, plain, false));
      if (cell->shown_in(decibel)) out.push_back(figure_of(*cell, decibel, true));
    }
    if (cell->shown_in("Section 3.5")) choices.add(spec, index, *cell);
  }
  if (auto figure = choices.figure()) out.push_back(std::move(*figure));
  return out;
}

}  // namespace fatmc::estimators
