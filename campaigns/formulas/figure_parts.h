// The parts of formula_figures(), each in a file of its own.
#pragma once

#include <string>
#include <vector>

#include "campaigns/base/study.h"

namespace fatmc {

StudyFigure figure_2_17();
StudyFigure figure_2_18();
StudyFigure figure_2_19();
StudyFigure figure_2_20();
StudyFigure figure_2_34();
StudyFigure figure_2_35();
StudyFigure figure_3_6();

/// A figure of a single, larger panel.
StudyFigure one_panel(std::string id, std::string title, std::string caption, plot::Panel panel);

/// `count` values from `low` to `high`, evenly spaced.
std::vector<double> linear_steps(double low, double high, int count);
/// The same by equal ratios; low > 0.
std::vector<double> logarithmic_steps(double low, double high, int count);

}  // namespace fatmc
