#include "campaigns/formulas/formula_figures.h"

#include <cmath>

#include "campaigns/formulas/figure_parts.h"

namespace fatmc {

std::vector<StudyFigure> formula_figures() {
  return {figure_2_17(), figure_2_18(), figure_2_19(), figure_2_20(),
          figure_2_34(), figure_2_35(), figure_3_6()};
}

StudyFigure one_panel(std::string id, std::string title, std::string caption, plot::Panel panel) {
  StudyFigure out{std::move(id), std::move(caption), {}};
  out.figure.title = std::move(title);
  out.figure.panel_width = 520.0;
  out.figure.panel_height = 320.0;
  out.figure.panels.push_back(std::move(panel));
  return out;
}

std::vector<double> linear_steps(double low, double high, int count) {
  std::vector<double> out;
  for (int i = 0; i < count; ++i) out.push_back(low + (high - low) * i / (count - 1));
  return out;
}

std::vector<double> logarithmic_steps(double low, double high, int count) {
  std::vector<double> out;
  for (const double exponent : linear_steps(std::log(low), std::log(high), count))
    out.push_back(std::exp(exponent));
  return out;
}

}  // namespace fatmc
