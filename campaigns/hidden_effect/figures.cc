#include "campaigns/hidden_effect/figures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/stats/empirical.h"
#include "core/stats/intervals.h"

namespace fatmc::hidden_effect {
namespace {

constexpr std::array<plot::Hue, 6> kHues = {plot::Hue::blue,   plot::Hue::orange, plot::Hue::green,
                                            plot::Hue::purple, plot::Hue::red,    plot::Hue::grey};

plot::Hue hue_of(std::size_t number) { return kHues[number % kHues.size()]; }

/// Cells in which something that candidates describe was hidden, and answers are judged by name.
std::vector<const CellResults*> known_cells(const std::vector<CellResults>& cells) {
  std::vector<const CellResults*> out;
  for (const CellResults& cell : cells) {
    if (cell.trials() > 0 && cell.tier.draw.effects > 0 && cell.tier.role != Role::unknown)
      out.push_back(&cell);
  }
  return out;
}

/// Shares with their 95 % intervals as points on vertical lines.
class ShareMarks {
 public:
  ShareMarks(std::string name, plot::Hue hue) : points_{std::move(name), {}, {}, hue, true, 2.5} {}
  void add(double x, const Count& count) {
    if (count.n == 0) return;
    const Interval interval = proportion_interval(count.hits, count.n);
    points_.x.push_back(x);
    points_.y.push_back(100.0 * static_cast<double>(count.hits) / static_cast<double>(count.n));
    bars_.x.insert(bars_.x.end(), {x, x, x});
    bars_.y.insert(bars_.y.end(), {100.0 * interval.low, 100.0 * interval.high, NAN});
  }
  void put(plot::Panel& panel) {
    bars_.hue = points_.hue;
    panel.marks.emplace_back(std::move(bars_));
    panel.marks.emplace_back(std::move(points_));
  }

 private:
  plot::Points points_;
  plot::Line bars_;
};

/// Right names and coverage of every effect of a cell, beside each other.
StudyFigure by_effect(const CellResults& cell) {
  std::vector<std::string> names;
  std::vector<double> places;
  ShareMarks right("right name", plot::Hue::green), covered("95 % interval holds the truth", plot::Hue::blue);
  for (const auto& [number, one] : cell.by_effect) {
    const auto place = static_cast<double>(names.size());
    right.add(place - 0.15, one.right);
    covered.add(place + 0.15, one.covered);
    places.push_back(place);
    names.push_back(effect_name(number));
  }
  plot::Panel panel;
  panel.x = {"", plot::Scale::linear, plot::Range{-0.7, static_cast<double>(names.size()) - 0.3}, places,
             names};
  panel.y = {"share of trials, %", plot::Scale::linear, plot::Range{0.0, 102.0}, {}};
  right.put(panel);
  covered.put(panel);
  panel.marks.emplace_back(plot::Rule{"90 %, bar of every name at moderate size", 90.0});
  plot::Figure figure;
  figure.title = "Effect by effect, " + cell.name;
  figure.panel_width = std::max(420.0, 120.0 + 16.0 * static_cast<double>(names.size()));
  figure.panel_height = 420.0;
  figure.panels = {std::move(panel)};
  return {"Effect by effect, " + cell.name,
          "Share of the trials that hid the effect in which it was named, and of those in which it was named "
          "the share whose "
          "interval holds the first parameter; with 95 % intervals (Wilson).",
          std::move(figure)};
}

/// Shares of the trials in bins of equal numbers, by a size.
plot::Panel by_size(const std::vector<const CellResults*>& cells, const std::string& label,
                    double HiddenOne::*size) {
  constexpr std::size_t kBins = 12, kLeast = 10;
  std::vector<HiddenOne> all;
  for (const CellResults* cell : cells) {
    if (cell->tier.draw.effects != 1) continue;
    for (const HiddenOne& one : cell->hidden) {
      if (one.*size > 0.0) all.push_back(one);
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [&](const HiddenOne& a, const HiddenOne& b) { return a.*size < b.*size; });
  plot::Panel panel;
  panel.x = {label, plot::Scale::logarithmic, {}, {}};
  panel.y = {"share of trials, %", plot::Scale::linear, plot::Range{0.0, 102.0}, {}};
  ShareMarks detected("detected", plot::Hue::blue), right("right name", plot::Hue::green);
  const std::size_t bins = std::clamp<std::size_t>(all.size() / kLeast, 1, kBins);
  for (std::size_t b = 0; b < bins && !all.empty(); ++b) {
    const std::size_t first = all.size() * b / bins, last = all.size() * (b + 1) / bins;
    Count found, named;
    for (std::size_t i = first; i < last; ++i) {
      found.add(all[i].detected);
      named.add(all[i].right);
    }
    const double middle = all[(first + last) / 2].*size;
    detected.add(middle, found);
    right.add(middle * 1.03, named);
  }
  if (!all.empty()) panel.x.range = plot::Range{0.9 * all.front().*size, 1.1 * all.back().*size};
  detected.put(panel);
  right.put(panel);
  return panel;
}

StudyFigure detection(const std::vector<const CellResults*>& cells) {
  plot::Figure figure;
  figure.title = "Detection by size";
  figure.columns = 2;
  figure.panel_width = 400.0;
  figure.panel_height = 260.0;
  figure.panels = {
      by_size(cells, "size, in least moderate sizes", &HiddenOne::size),
      by_size(cells, "discrepancy above the floor, chi-square per feature", &HiddenOne::discrepancy)};
  return {"Detection by size",
          "Trials with one hidden effect of all cells whose effects are candidates, in up to twelve bins of "
          "equal numbers, with 95 % "
          "intervals (Wilson); right: by what the effect did to a record that was not diagnosed.",
          std::move(figure)};
}

/// Distribution function of values in %, as steps of a line.
plot::Line distribution(std::string name, std::vector<double> values, plot::Hue hue, double factor = 100.0,
                        plot::Dash dash = plot::Dash::solid) {
  std::sort(values.begin(), values.end());
  plot::Line out{std::move(name), {}, {}, hue, dash};
  for (std::size_t i = 0; i < values.size(); ++i) {
    out.x.push_back(factor * std::max(values[i], 1e-6));
    out.y.push_back(100.0 * static_cast<double>(i + 1) / static_cast<double>(values.size()));
  }
  return out;
}

StudyFigure parameter_errors(const std::vector<const CellResults*>& cells) {
  plot::Panel panel;
  panel.x = {
      "parameter error, % of the effect's size", plot::Scale::logarithmic, plot::Range{0.01, 100.0}, {}};
  panel.y = {"share of right names, %", plot::Scale::linear, plot::Range{0.0, 102.0}, {}};
  for (std::size_t c = 0; c < cells.size(); ++c)
    panel.marks.emplace_back(distribution(cells[c]->name, cells[c]->parameter_error, hue_of(c)));
  panel.marks.emplace_back(plot::Rule{"2 % and 5 %, bars of median and 90 % quantile", 2.0, true});
  panel.marks.emplace_back(plot::Rule{"2 % and 5 %, bars of median and 90 % quantile", 5.0, true});
  plot::Figure figure;
  figure.title = "Errors of the parameters";
  figure.panel_width = 560.0;
  figure.panel_height = 280.0;
  figure.panels = {std::move(panel)};
  return {"Errors of the parameters",
          "First parameter of every effect that was named: distance of the estimate from the truth over that "
          "of the truth from "
          "nominal, on the natural scale; of limits, which have no such distance, the relative error.",
          std::move(figure)};
}

StudyFigure gaps(const std::vector<const CellResults*>& cells) {
  plot::Figure figure;
  figure.title = "The gap on records that were not diagnosed";
  figure.columns = 2;
  figure.panel_width = 400.0;
  figure.panel_height = 230.0;
  for (const CellResults* cell : cells) {
    if (cell->gap_before.empty()) continue;
    plot::Panel panel;
    panel.title = cell->name;
    panel.x = {"whitened chi-square per feature", plot::Scale::logarithmic, {}, {}};
    panel.y = {"share of trials, %", plot::Scale::linear, plot::Range{0.0, 102.0}, {}};
    panel.marks = {distribution("before", cell->gap_before, plot::Hue::red, 1.0),
                   distribution("after", cell->gap_after, plot::Hue::blue, 1.0),
                   plot::Rule{"floor", EmpiricalCdf(cell->gap_floor).quantile(0.5), true}};
    figure.panels.push_back(std::move(panel));
  }
  if (figure.panels.empty()) figure.panels.emplace_back();
  return {"The gap before and after",
          "Trials whose unseen record shows a discrepancy beyond chance; before: the unchanged model, after: "
          "with what was named.",
          std::move(figure)};
}

}  // namespace

Result<std::vector<StudyFigure>> figures(const CampaignSpec& spec, const RowSource& rows) {
  auto cells = read_results(spec, rows);
  if (!cells) return fail(cells.error());
  std::vector<StudyFigure> out;
  for (const CellResults& cell : *cells) {
    if (!cell.confusion.empty()) out.push_back(confusion_figure(cell));
  }
  const std::vector<const CellResults*> known = known_cells(*cells);
  if (known.empty()) return out;
  for (const CellResults* cell : known) out.push_back(by_effect(*cell));
  out.push_back(detection(known));
  out.push_back(parameter_errors(known));
  out.push_back(gaps(known));
  return out;
}

}  // namespace fatmc::hidden_effect
