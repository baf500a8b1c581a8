// Marks of a panel as SVG elements.
#pragma once

#include <string>

#include "coordinator/plot/axis_scale.h"
#include "campaigns/base/figure.h"

namespace fatmc::plot {

/// The elements of one mark, coloured by the classes of svg.cc. A line or band of more points than the panel
/// has pixels is thinned to first, lowest, highest and last of each pixel column, which draws the same
/// picture.
std::string mark_svg(const Mark& mark, const AxisScale& x, const AxisScale& y);

/// The mark's sample in the legend: 18 px wide, centred on height `y_px`.
std::string legend_sample(const Mark& mark, double x_px, double y_px);

/// Name of the mark, empty for none.
const std::string& name_of(const Mark& mark);

/// A pixel coordinate with one decimal.
std::string px(double value);

}  // namespace fatmc::plot
