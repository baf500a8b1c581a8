#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "campaigns/variance/element_runs.h"
#include "campaigns/variance/summary.h"

namespace fatmc::variance {
namespace {

constexpr std::array kOutputs = {"p", "q", "r"};
constexpr std::array kInputs = {"xi_c", "eta_c", "zeta_c"};

// Boxes stand side by side as in T: their distance is no distance in frequency, ticks carry no numbers of Hz.
plot::Figure nine_panels(const ElementRuns& runs) {
  std::vector<std::size_t> all(runs.runs());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const std::size_t lines = runs.frequency_hz.size();
  plot::Figure figure;
  figure.title = "Variance of the estimate, from one run and between runs";
  figure.columns = 3;
  figure.note = "Lines side by side: all from 0.05 to 0.20 Hz and from 4.85 to 5 Hz, every tenth between.";
  for (std::size_t e = 0; e < kElements; ++e) {
    plot::Panel panel;
    panel.title = std::string(kOutputs[e / 3]) + "/" + kInputs[e % 3];
    panel.x.label = e / 3 == 2 ? "Line shown" : "";
    panel.y.label = e % 3 == 0 ? "Variance (dB)" : "";
    plot::Boxes boxes;
    boxes.name = "estimated from one run";
    boxes.width = 0.6;
    plot::Line between{"between the runs", {}, {}, plot::Hue::orange};
    for (std::size_t k = 0; k < lines; ++k) {
      std::vector<double> decibel;
      for (const double variance : runs.variance.line(ElementRuns::at(k, e)))
        decibel.push_back(10.0 * std::log10(variance));
      const double x = static_cast<double>(k + 1);
      if (auto box = plot::box_of(std::move(decibel))) {
        boxes.x.push_back(x);
        boxes.boxes.push_back(std::move(*box));
      }
      between.x.push_back(x);
      between.y.push_back(10.0 * std::log10(runs.between_runs(k, e, all)));
    }
    panel.marks.emplace_back(std::move(boxes));
    panel.marks.emplace_back(std::move(between));
    figure.panels.push_back(std::move(panel));
  }
  return figure;
}

}  // namespace

Result<std::vector<StudyFigure>> figures(const CampaignSpec& spec, const RowSource& rows) {
  std::vector<StudyFigure> out;
  if (spec.cells.empty()) return out;
  const ElementRuns runs = element_runs(0, rows);
  if (runs.runs() < 2) return out;
  out.push_back(
      {"Fig. 4-3",
       "Variance of the estimate, (rad/s)^2 in dB: estimated from each of " + std::to_string(runs.runs()) +
           " runs (boxes: quartiles, whiskers to 1.5 interquartile ranges) and the scatter between the runs.",
       nine_panels(runs)});
  return out;
}

}  // namespace fatmc::variance
