// Figs. 2-17 to 2-20: what a polynomial makes of a lightly damped peak.
#include <algorithm>
#include <cmath>

#include "campaigns/formulas/figure_parts.h"
#include "campaigns/formulas/lightly_damped.h"
#include "core/base/text.h"
#include "core/ident/design_formulas.h"
#include "core/ident/interpolation_bias.h"

namespace fatmc {
namespace {

constexpr int kOrder = 2;

plot::Line response_line(const LightlyDamped& system, std::span<const double> x) {
  plot::Line out{"response", {x.begin(), x.end()}, {}, plot::Hue::blue};
  for (const double at : x) out.y.push_back(std::abs(system.response(at)));
  return out;
}

/// Lines of a window and the polynomial through their magnitudes, drawn over the window.
void add_window(const LightlyDamped& system, double centre, const std::string& name, plot::Hue hue,
                plot::Panel& panel) {
  const std::vector<double> offsets = even_offsets(7, kFigure217Width);
  const std::vector<double> fine = even_offsets(101, kFigure217Width);
  plot::Line fit{name,
                 {},
                 polynomial_values(system, centre, offsets, kOrder, FittedPart::magnitude, fine),
                 hue,
                 plot::Dash::dashed};
  for (const double d : fine) fit.x.push_back(centre + d);
  plot::Points lines{name, {}, {}, hue};
  for (const double d : offsets) {
    lines.x.push_back(centre + d);
    lines.y.push_back(std::abs(system.response(centre + d)));
  }
  panel.marks.emplace_back(std::move(fit));
  panel.marks.emplace_back(std::move(lines));
}

plot::Panel peak_panel(const LightlyDamped& system) {
  plot::Panel panel;
  panel.x.label = "(ω − ω_N) / (ζ ω0)";
  panel.y.label = "|G| / |G(ω_N)|";
  const std::vector<double> x = linear_steps(-2.0, 2.0, 201);
  panel.marks.emplace_back(response_line(system, x));
  return panel;
}

/// alpha of one window (2.135), (2.137): |error at the window's centre| (B_lpm/B_3dB)^-(R+2) over the part's value at the
/// peak.
double alpha_of(const LightlyDamped& system, double centre, std::span<const double> offsets,
                FittedPart part) {
  const std::complex<double> at_centre = system.response(centre), at_peak = system.response(0.0);
  const bool magnitude = part == FittedPart::magnitude;
  const double truth = magnitude ? std::abs(at_centre) : at_centre.imag();
  const double scale = magnitude ? std::abs(at_peak) : std::abs(at_peak.imag());
  const double error = std::abs(polynomial_at_centre(system, centre, offsets, kOrder, part) - truth);
  return error / scale * std::pow(offsets.back(), -(kOrder + 2));
}

/// Dampings from near 0 to 0.8, for each 51 windows whose centres lie within +-B_lpm of the peak.
StudyFigure constant_figure(std::string id, std::string title, FittedPart part, double limit,
                            std::string caption) {
  constexpr double kWidth = 0.12;  // B_lpm / B_3dB: the width that reproduces Table 2-4; T prints none
  const std::vector<double> offsets = even_offsets(51, kWidth);
  plot::Line centred{"window centred at the peak", {}, {}, plot::Hue::orange};
  plot::Band shifted{"windows shifted by up to B_lpm", {}, {}, {}, plot::Hue::blue};
  // 51 lines, ends included, reach over 51/50 of their spacing each: B_lpm = (2 n_E + 1) df is that much wider.
  const double lines = std::pow(50.0 / 51.0, kOrder + 2);
  for (const double damping : linear_steps(0.005, 0.8, 160)) {
    const LightlyDamped system(damping);
    double low = limit * 10.0, high = 0.0;
    for (const double centre : linear_steps(-2.0 * kWidth, 2.0 * kWidth, 51)) {
      const double alpha = lines * alpha_of(system, centre, offsets, part);
      low = std::min(low, alpha);
      high = std::max(high, alpha);
    }
    centred.x.push_back(damping);
    centred.y.push_back(lines * alpha_of(system, 0.0, offsets, part));
    shifted.x.push_back(damping);
    shifted.low.push_back(low);
    shifted.high.push_back(high);
  }
  plot::Panel panel;
  panel.x.label = "damping ζ";
  panel.y.label = "α4";
  panel.y.range = plot::Range{0.0, 1.6 * limit};
  panel.marks = {std::move(shifted), std::move(centred), plot::Rule{"limit of narrow windows, ζ → 0", limit}};
  return one_panel(std::move(id), std::move(title), std::move(caption), std::move(panel));
}

}  // namespace

StudyFigure figure_2_17() {
  const LightlyDamped system(kFigure217Damping);
  plot::Panel panel = peak_panel(system);
  add_window(system, 0.0, "fit to the magnitude, 7 lines over 0.8 B_3dB", plot::Hue::orange, panel);
  panel.marks.emplace_back(plot::Rule{"3 dB below the peak", std::sqrt(0.5)});
  return one_panel(
      "Fig. 2-17", "Interpolation error at a resonance peak",
      "A polynomial of degree 2 through seven lines of the magnitude of a mode with damping " +
          significant(kFigure217Damping, 2) +
          ": it misses the peak by 1.1 %. The fast LPM fits the complex response, and misses it by 2.7 %.",
      std::move(panel));
}

StudyFigure figure_2_18() {
  const LightlyDamped system(kFigure217Damping);
  plot::Panel panel = peak_panel(system);
  add_window(system, 0.0, "centred window", plot::Hue::orange, panel);
  add_window(system, 0.7, "shifted window", plot::Hue::purple, panel);
  return one_panel("Fig. 2-18", "Centred and shifted windows",
                   "Windows of seven lines over 0.8 B_3dB, one about the peak, one shifted by 0.7 ζ ω0.",
                   std::move(panel));
}

StudyFigure figure_2_19() {
  return constant_figure(
      "Fig. 2-19", "Interpolation constant of the imaginary part", FittedPart::imaginary,
      limit_bias_constant(kOrder),
      "α4 by (2.135): 160 dampings, for each 51 windows of B_lpm = 0.12 B_3dB with 51 lines. The "
      "width is not printed. Up to a damping of 0.25 the constant is that of Table 2-3; beyond, the "
      "real part is no longer odd about the peak, and it grows.");
}

StudyFigure figure_2_20() {
  return constant_figure(
      "Fig. 2-20", "Interpolation constant of the magnitude", FittedPart::magnitude,
      magnitude_bias_constant(kOrder),
      "α4 by (2.137), same systems and windows as Fig. 2-19. The largest value is that of a window at "
      "the peak with little damping; it bounds a fit to the magnitude, not the LPM, which fits the "
      "complex response.");
}

}  // namespace fatmc
