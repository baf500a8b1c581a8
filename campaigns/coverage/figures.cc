#include <algorithm>
#include <array>
#include <utility>

#include "campaigns/base/line_runs.h"
#include "campaigns/coverage/covered_runs.h"
#include "campaigns/coverage/insensitivity.h"
#include "campaigns/coverage/row_arrays.h"
#include "campaigns/coverage/summary.h"
#include "core/stats/confidence.h"

namespace fatmc::coverage {
namespace {

constexpr std::array kAxes = {"roll", "pitch", "yaw"};

plot::Axis frequency_axis() {
  plot::Axis axis;
  axis.label = "Frequency (Hz)";
  axis.scale = plot::Scale::logarithmic;
  return axis;
}

plot::Figure insensitivity_figure(const Insensitivity& s) {
  constexpr std::array hues = {plot::Hue::blue, plot::Hue::orange, plot::Hue::green};
  plot::Panel panel;
  panel.x = frequency_axis();
  panel.y.label = "|S| (dB)";
  for (std::size_t axis = 0; axis < kAxes.size(); ++axis)
    panel.marks.emplace_back(plot::Line{kAxes[axis], s.frequency_hz, s.decibel[axis], hues[axis]});
  plot::Figure figure;
  figure.panel_width = 600.0;
  figure.panel_height = 260.0;
  figure.panels.push_back(std::move(panel));
  return figure;
}

// Fig. 5-3: a panel an input, a box a line.
plot::Figure snr_figure(const std::vector<LineRuns>& snr, const std::vector<double>& frequency_hz) {
  plot::Figure figure;
  figure.columns = static_cast<int>(snr.size());
  for (std::size_t input = 0; input < snr.size(); ++input) {
    plot::Panel panel;
    panel.title = snr.size() == kAxes.size() ? std::string(kAxes[input]) + " command"
                                             : "input " + std::to_string(input + 1);
    panel.x = frequency_axis();
    panel.y.label = input == 0 ? "SNR(U) (dB)" : "";
    plot::Boxes boxes = boxes_of(snr[input], frequency_hz);
    boxes.relative = true;
    boxes.width = 0.012;  // lines are as near as 1.3 % of their frequency
    panel.marks.emplace_back(std::move(boxes));
    panel.marks.emplace_back(plot::Rule{"20 dB", 20.0});
    figure.panels.push_back(std::move(panel));
  }
  return figure;
}

// Distribution functions of |e|^2/sigma^2 under the rules, at steps of 0.05 up to 6.
class Distributions {
 public:
  void add(const TrialErrors& errors) {
    for (std::size_t r = 0; r < kRegions.size(); ++r) {
      if (kRegions[r] == Region::sample && errors.sample_error.empty()) continue;
      if (needs_printed_constant(kRegions[r]) && errors.bias_printed.empty()) continue;
      for (std::size_t i = 0; i < errors.error.size(); ++i) {
        const double bin = normalised_square(errors, kRegions[r], i) / kStep;
        ++count_[r];
        if (bin < kBins) ++bins_[r][static_cast<std::size_t>(bin)];
      }
    }
  }

  [[nodiscard]] plot::Figure figure(int q) const {
    constexpr std::array hues = {plot::Hue::green, plot::Hue::blue,   plot::Hue::purple,
                                 plot::Hue::blue,  plot::Hue::purple, plot::Hue::grey};
    plot::Panel panel;
    panel.x.label = "x";
    panel.y.label = "P(|e|²/σ² ≤ x)";
    panel.y.range = plot::Range{0.0, 1.02};
    std::vector<double> x, law;
    for (std::size_t b = 0; b <= kBins; ++b) {
      x.push_back(kStep * static_cast<double>(b));
      law.push_back(f_cdf_2_2q(x.back(), q));
    }
    for (std::size_t r = 0; r < kRegions.size(); ++r) {
      if (count_[r] == 0) continue;
      plot::Line line{std::string(region_name(kRegions[r])), x, {0.0}, hues[r]};
      if (needs_printed_constant(kRegions[r])) line.dash = plot::Dash::dotted;
      double sum = 0.0;
      for (const std::uint64_t n : bins_[r]) {
        sum += static_cast<double>(n);
        line.y.push_back(sum / static_cast<double>(count_[r]));
      }
      panel.marks.emplace_back(std::move(line));
    }
    panel.marks.emplace_back(
        plot::Line{"F(2, " + std::to_string(2 * q) + ")", x, law, plot::Hue::orange, plot::Dash::dashed});
    plot::Figure figure;
    figure.panel_width = 600.0;
    figure.panel_height = 300.0;
    figure.panels.push_back(std::move(panel));
    return figure;
  }

 private:
  static constexpr double kStep = 0.05;
  static constexpr std::size_t kBins = 120;
  std::array<std::array<std::uint64_t, kBins>, kRegions.size()> bins_{};
  std::array<std::uint64_t, kRegions.size()> count_{};
};

}  // namespace

Result<std::vector<StudyFigure>> figures(const CampaignSpec& spec, const RowSource& rows) {
  std::vector<StudyFigure> out;
  if (spec.cells.empty()) return out;
  Distributions distributions;
  std::vector<LineRuns> snr;
  int q = 0;
  for_each_run(0, rows, [&](const TrialRow& row, const TrialErrors& errors) {
    q = static_cast<int>(metric_of(row, kDegreesOfFreedom));
    distributions.add(errors);
    const auto& values = array_of(row, kInputSnr);
    snr.resize(static_cast<std::size_t>(metric_of(row, kInputs)));
    for (std::size_t input = 0; input < snr.size(); ++input) {
      std::vector<double> own;
      for (std::size_t at = input; at < values.size(); at += snr.size()) own.push_back(values[at]);
      snr[input].add(own);
    }
  });
  if (snr.empty()) return out;
  const auto lines = insensitivity_at_lines(spec);
  if (!lines) return fail(lines.error());
  const auto curve = insensitivity_curve(spec);
  if (!curve) return fail(curve.error());
  const std::string n = std::to_string(snr.front().runs()) + " runs";
  const auto add = [&](const char* id, const char* title, std::string caption, plot::Figure figure) {
    figure.title = title;
    out.push_back({id, std::move(caption), std::move(figure)});
  };
  add("Fig. 5-2", "Insensitivity to turbulence",
      "Insensitivity to rotating gusts of the same axis, from the linearised model.",
      insensitivity_figure(*curve));
  add("Fig. 5-3", "Input signal-to-noise ratio",
      "Input signal-to-noise ratio, " + n +
          " a box: quartiles and median, whiskers to 1.5 interquartile ranges.",
      snr_figure(snr, lines->frequency_hz));
  add("Fig. 5-4", "Normalised errors and their law",
      "Distribution of the normalised error over all lines and elements of " + n + ", and its law.",
      distributions.figure(q));
  return out;
}

}  // namespace fatmc::coverage
