// Figs. 2-34, 2-35 and 3-6: what hides between the lines, and how far apart lines may be.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "campaigns/formulas/figure_parts.h"
#include "campaigns/formulas/published.h"
#include "core/base/text.h"
#include "core/ident/design_formulas.h"
#include "core/signal/multisine.h"

namespace fatmc {
namespace {

struct Resolution {
  const char* name;
  plot::Hue hue;
  std::vector<double> frequency_hz, spacing_hz;
};

Resolution even_lines(const char* name, plot::Hue hue, double low, double high, double spacing) {
  Resolution out{name, hue, logarithmic_steps(low, high, 60), {}};
  out.spacing_hz.assign(out.frequency_hz.size(), spacing);
  return out;
}

/// Spacing of the ranges of Table 5-1, drawn as steps.
Resolution chapter_5() {
  Resolution out{"chapter 5", plot::Hue::purple, {}, {}};
  for (const FrequencyRange& range : table_5_1_ranges()) {
    for (const double f : logarithmic_steps(range.start_hz, range.stop_hz, 20)) {
      out.frequency_hz.push_back(f);
      out.spacing_hz.push_back(range.step_hz);
    }
  }
  return out;
}

}  // namespace

StudyFigure figure_2_34() {
  plot::Panel panel;
  panel.x = {"f0, Hz", plot::Scale::logarithmic, {}, {}};
  panel.y = {"damping ζ", plot::Scale::logarithmic, {}, {}};
  for (const Resolution& lines : {even_lines("chapter 4", plot::Hue::orange, 0.05, 5.0, 0.01), chapter_5()}) {
    plot::Line corrected{std::string(lines.name) + ", Δf/(2 f0)", lines.frequency_hz, {}, lines.hue};
    plot::Line printed{std::string(lines.name) + ", Δf/(4π f0) as printed (2.262)",
                       lines.frequency_hz,
                       {},
                       lines.hue,
                       plot::Dash::dotted};
    for (std::size_t i = 0; i < lines.frequency_hz.size(); ++i) {
      const double damping = intergrid_damping_3db(lines.spacing_hz[i], lines.frequency_hz[i]);
      corrected.y.push_back(damping);
      printed.y.push_back(damping / (2.0 * std::numbers::pi));
    }
    panel.marks.emplace_back(std::move(corrected));
    panel.marks.emplace_back(std::move(printed));
  }
  panel.marks.emplace_back(
      plot::Points{"aeroelastic mode, 2 Hz, 0.05", {2.0}, {0.05}, plot::Hue::red, false, 4.0});
  return one_panel(
      "Fig. 2-34", "Damping that hides 3 dB between two lines",
      "Peaks below a curve may hide more than 3 dB between two lines. Printed is Δf/(4π f0), a factor 2π too "
      "small (B_3dB = 2ζ f0 in Hz); the aeroelastic mode lies above all curves nevertheless.",
      std::move(panel));
}

StudyFigure figure_2_35() {
  plot::Panel panel;
  panel.x = {"damping ζ", plot::Scale::logarithmic, {}, {}};
  panel.y = {"Δf / f0", plot::Scale::logarithmic, {}, {}};
  struct Contour {
    double error;
    const char* name;
    plot::Hue hue;
  };
  const std::array<Contour, 5> contours = {{{0.01, "1 %", plot::Hue::blue},
                                            {0.03, "3 %", plot::Hue::green},
                                            {0.05, "5 %", plot::Hue::orange},
                                            {0.1, "10 %", plot::Hue::purple},
                                            {1.0 - std::sqrt(0.5), "3 dB", plot::Hue::red}}};
  const std::vector<double> damping = logarithmic_steps(1e-3, 1.0, 60);
  for (const Contour& contour : contours) {
    plot::Line line{contour.name, damping, {}, contour.hue};
    for (const double zeta : damping) line.y.push_back(intergrid_relative_spacing(contour.error, zeta));
    panel.marks.emplace_back(std::move(line));
  }
  panel.marks.emplace_back(plot::Points{"Δf/f0 = 0.005, 5 %",
                                        {intergrid_covered_damping(0.05, 0.005, 1.0)},
                                        {0.005},
                                        plot::Hue::grey,
                                        false,
                                        4.0});
  return one_panel(
      "Fig. 2-35", "Line spacing that limits the intergrid error",
      "Largest Δf/f0 with which no peak of that damping hides more than the error of its curve: 2ζ √((1 − "
      "error)⁻² − 1).",
      std::move(panel));
}

StudyFigure figure_3_6() {
  plot::Panel panel;
  panel.x = {"f, Hz", plot::Scale::logarithmic, {}, {}};
  panel.y = {"Δf, Hz", plot::Scale::logarithmic, {}, {}};
  plot::Points modes{"modes, Δf of Table 3-1", {}, {}, plot::Hue::blue, false, 3.0};
  plot::Line between{"", {}, {}, plot::Hue::blue, plot::Dash::dotted};
  plot::Line corrected{"by (2.140) corrected", {}, {}, plot::Hue::grey, plot::Dash::dotted};
  for (const formulas::ModeRow& mode : formulas::kTable31) {
    const double f0 = mode.f0.value, damping = mode.damping.value;
    const double spacing = 1.0 / recommended_duration_s(f0, damping, 2, DurationRule::table_3_1);
    modes.x.push_back(f0);
    modes.y.push_back(spacing);
    corrected.x.push_back(f0);
    corrected.y.push_back(1.0 / recommended_duration_s(f0, damping, 2, DurationRule::corrected));
  }
  between.x = modes.x;
  between.y = modes.y;
  panel.marks = {std::move(between), std::move(corrected), std::move(modes)};
  for (const Resolution& lines : {even_lines("chapter 3", plot::Hue::orange, 0.05, 1.0, 0.05),
                                  even_lines("chapter 4", plot::Hue::green, 0.05, 5.0, 0.01), chapter_5()}) {
    panel.marks.emplace_back(plot::Line{lines.name, lines.frequency_hz, lines.spacing_hz, lines.hue});
  }
  return one_panel(
      "Fig. 3-6", "Frequency resolutions of the experiments",
      "Lines below the dotted curve are close enough for the fast LPM at that mode (Table 3-1's rule; grey: "
      "with the corrected (2.140)). Chapter 3 is too coarse for the phugoid, by intention.",
      std::move(panel));
}

}  // namespace fatmc
