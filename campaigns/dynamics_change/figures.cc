#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "campaigns/dynamics_change/alarms.h"
#include "campaigns/dynamics_change/summary.h"
#include "core/base/text.h"
#include "core/stats/empirical.h"

namespace fatmc::dynamics_change {
namespace {

/// Values of all runs by time since the onset, in whole epochs.
using History = std::map<long, std::vector<double>>;

History history(const MonitoredCell& cell,
                const std::function<std::vector<double>(const MonitoredRun&)>& values) {
  History out;
  for (const MonitoredRun& run : cell.runs) {
    const std::vector<double> series = values(run);
    for (std::size_t i = 0; i < series.size(); ++i) {
      if (!std::isnan(series[i]))
        out[std::lround((run.time(i) - run.onset_s) / run.epoch_s)].push_back(series[i]);
    }
  }
  return out;
}

plot::Panel history_panel(const std::string& title, const std::string& label, double epoch_s,
                          const History& values, double threshold) {
  plot::Panel panel;
  panel.title = title;
  panel.x.label = "time since the change, s";
  panel.y.label = label;
  plot::Band band;
  plot::Line median, first;
  band.name = "quartiles over runs";
  median.name = "median";
  first.name = "a flight";
  first.hue = plot::Hue::grey;
  first.dash = plot::Dash::dashed;
  for (const auto& [epoch, at] : values) {
    const EmpiricalCdf cdf(at);
    const double x = epoch_s * static_cast<double>(epoch);
    band.x.push_back(x);
    band.low.push_back(cdf.quantile(0.25));
    band.high.push_back(cdf.quantile(0.75));
    median.x.push_back(x);
    median.y.push_back(cdf.quantile(0.5));
    first.x.push_back(x);
    first.y.push_back(at.front());
  }
  panel.marks = {band, first, median, plot::Rule{"threshold", threshold},
                 plot::Rule{"", 0.0, true, plot::Hue::grey, plot::Dash::dotted}};
  return panel;
}

StudyFigure history_figure(const CampaignSpec& spec, const std::map<std::uint32_t, MonitoredCell>& cells,
                           Detector detector, double threshold) {
  StudyFigure out;
  const bool csl = detector != Detector::noise_rise;
  out.id = detector == Detector::csl ? "Fig. 5-16"
           : csl                     ? "Fig. 5-16 without gates"
                                     : "Noise rise after a change";
  out.figure.title = csl ? "Confident stability level around a change of the dynamics"
                         : "Rise of the estimated noise within a quarter window";
  out.figure.columns = 2;
  std::size_t runs = 0;
  for (const auto& [index, cell] : cells) {
    if (std::isinf(cell.runs.front().onset_s)) continue;
    runs += cell.runs.size();
    const History values = history(cell, [&](const MonitoredRun& run) {
      return detector == Detector::csl ? run.csl : csl ? run.robust : alarm_statistic(run, detector);
    });
    if (values.empty()) continue;
    plot::Panel panel = history_panel(spec.cells[index].name, csl ? "CSL" : "D", cell.runs.front().epoch_s,
                                      values, threshold);
    if (csl) panel.y.range = plot::Range{0.0, 1.0};
    out.figure.panels.push_back(std::move(panel));
  }
  out.caption =
      std::to_string(runs) + " flights. " +
      (csl ? (detector == Detector::csl ? "With" : "Without") +
                 std::string(
                     " the gates of nominal stability and SNR; before a full window it begins with zeros.")
           : "D: largest rise over a quarter window of the mean log noise of p, q, r; spectra from the lines "
             "between the excited ones.");
  return out;
}

/// Largest statistic of every unchanged hour, in ascending order.
std::vector<double> worst_hours(const std::map<std::uint32_t, MonitoredCell>& cells, Detector detector) {
  std::vector<double> out;
  for (const auto& [index, cell] : cells) {
    for (const MonitoredRun& run : cell.runs) {
      if (const double worst = worst_of_hour(run, detector); !std::isnan(worst)) out.push_back(worst);
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// A point a threshold that `worst` tells apart: at each of its values the larger ones alarm, below all of them all do. Not a
/// curve: an alarm that was on before counts as missed, so that a lower threshold may find less, and between two rates of
/// n hours there is none.
plot::Points detection_points(const std::vector<double>& worst, const std::vector<QuarterWindow>& found) {
  plot::Points out;
  const auto percent = [](std::ptrdiff_t part, std::size_t whole) {
    return 100.0 * static_cast<double>(part) / static_cast<double>(whole);
  };
  const auto add = [&](double threshold, std::ptrdiff_t alarmed) {
    const auto hits = std::count_if(found.begin(), found.end(), [&](const QuarterWindow& w) {
      return w.largest > threshold && !(w.before > threshold);
    });
    out.x.push_back(percent(alarmed, worst.size()));
    out.y.push_back(percent(hits, found.size()));
  };
  for (auto at = worst.begin(); at != worst.end(); at = std::upper_bound(at, worst.end(), *at))
    add(*at, worst.end() - std::upper_bound(at, worst.end(), *at));
  add(-std::numeric_limits<double>::infinity(), static_cast<std::ptrdiff_t>(worst.size()));
  return out;
}

plot::Panel roc_panel(const CampaignSpec& spec, const std::map<std::uint32_t, MonitoredCell>& cells,
                      Detector detector, const std::vector<double>& worst) {
  plot::Panel panel;
  panel.title = std::string(name(detector));
  panel.x.label = "hours with a false alarm, %";
  panel.y.label = "found in W/4, %";
  panel.x.range = panel.y.range = plot::Range{-3.0, 103.0};
  panel.x.ticks = panel.y.ticks = {0.0, 20.0, 40.0, 60.0, 80.0, 100.0};
  constexpr plot::Hue hues[] = {plot::Hue::blue,   plot::Hue::orange, plot::Hue::green,
                                plot::Hue::purple, plot::Hue::red,    plot::Hue::grey};
  std::size_t hue = 0;
  for (const auto& [index, cell] : cells) {
    if (std::isinf(cell.runs.front().onset_s)) continue;
    std::vector<QuarterWindow> found;
    for (const MonitoredRun& run : cell.runs)
      found.push_back(quarter_window(run, alarm_statistic(run, detector)));
    plot::Points points = detection_points(worst, found);
    points.name = spec.cells[index].name;
    points.filled = hue % 2 == 0;
    points.radius_px = 2.0 + 0.8 * static_cast<double>(hue);  // points of several cells stand in one place
    points.hue = hues[hue++ % std::size(hues)];
    panel.marks.emplace_back(std::move(points));
  }
  std::reverse(panel.marks.begin(), panel.marks.end());  // the smallest on top
  return panel;
}

/// Detection against false alarms, the threshold running through the worst values of the unchanged hours.
StudyFigure roc_figure(const CampaignSpec& spec, const std::map<std::uint32_t, MonitoredCell>& cells) {
  StudyFigure out;
  out.id = "Detection against false alarms";
  out.figure.title = "Changes found within a quarter window against hours with a false alarm";
  out.figure.columns = 2;
  std::size_t hours = 0;
  for (const Detector detector : kDetectors) {
    const std::vector<double> worst = worst_hours(cells, detector);
    if (worst.empty()) continue;
    hours = worst.size();
    out.figure.panels.push_back(roc_panel(spec, cells, detector, worst));
  }
  // 1 - (1 - p)^n = 95 %
  const double bound =
      100.0 * (1.0 - std::pow(0.05, 1.0 / static_cast<double>(std::max<std::size_t>(hours, 1))));
  out.caption = "A point a threshold, from " + std::to_string(hours) +
                " hours of flight without a change: no false alarm in any of them bounds the rate by " +
                significant(bound, 2) +
                " % (one-sided, 95 %). A flight whose alarm was on when the change came counts as missed.";
  return out;
}

}  // namespace

Result<std::vector<StudyFigure>> figures(const CampaignSpec& spec, const RowSource& rows) {
  const auto thresholds = decode_thresholds(spec);
  if (!thresholds) return fail(thresholds.error());
  std::map<std::uint32_t, MonitoredCell> cells;
  for (std::uint32_t index = 0; index < spec.cells.size(); ++index) {
    MonitoredCell cell = read_cell(index, rows);
    if (!cell.runs.empty()) cells.emplace(index, std::move(cell));
  }
  std::vector<StudyFigure> out;
  if (cells.empty()) return out;
  out.push_back(history_figure(spec, cells, Detector::csl, thresholds->csl));
  out.push_back(history_figure(spec, cells, Detector::robust, thresholds->csl));
  out.push_back(history_figure(spec, cells, Detector::noise_rise, thresholds->noise_rise));
  StudyFigure roc = roc_figure(spec, cells);
  if (!roc.figure.panels.empty()) out.push_back(std::move(roc));
  return out;
}

}  // namespace fatmc::dynamics_change
