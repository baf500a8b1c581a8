// What a figure shows, apart from how it is drawn: a grid of panels, each with two axes and marks in the
// data's units.
//
// svg.h draws it. A new kind of mark is a struct here, a member of Mark, and a function in marks.cc.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace fatmc::plot {

struct Range {
  double low = 0.0, high = 1.0;
};

enum class Scale { linear, logarithmic };

struct Axis {
  std::string label;  ///< with its unit; empty: none, as where the panel below has the same axis
  Scale scale = Scale::linear;
  std::optional<Range> range;  ///< none: what the panel's marks span
  std::vector<double> ticks;   ///< empty: round numbers
};

/// Hues that differ in light and dark and to colour-blind eyes.
enum class Hue { blue, orange, green, purple, red, grey };
enum class Dash { solid, dashed, dotted };

// Coordinates that are not finite, or not positive on a logarithmic axis, are gaps: a line breaks there.
// Marks of one name share an entry of the legend; an empty name has none. x and y (low, high) have equal
// lengths.

/// A polyline.
struct Line {
  std::string name;
  std::vector<double> x, y;
  Hue hue = Hue::blue;
  Dash dash = Dash::solid;
};

/// The area between two curves.
struct Band {
  std::string name;
  std::vector<double> x, low, high;
  Hue hue = Hue::blue;
};

/// A dot, or a ring where `filled` is false, a point.
struct Points {
  std::string name;
  std::vector<double> x, y;
  Hue hue = Hue::blue;
  bool filled = true;
};

/// A histogram: bar i stands on edges[i] ... edges[i + 1], from zero (or the axis' end) to heights[i].
struct Bars {
  std::string name;
  std::vector<double> edges, heights;
  Hue hue = Hue::blue;
};

/// A straight line through the panel at one value of an axis; it does not widen the axis.
struct Rule {
  std::string name;
  double at = 0.0;
  bool vertical = false;
  Hue hue = Hue::grey;
  Dash dash = Dash::dashed;
};

using Mark = std::variant<Line, Band, Points, Bars, Rule>;

struct Panel {
  std::string title;
  Axis x, y;
  std::vector<Mark> marks;  ///< drawn in this order, later ones on top
};

struct Figure {
  std::string title;
  std::string note;                                  ///< one line below the title
  int columns = 1;                                   ///< panels fill row after row
  double panel_width = 340.0, panel_height = 190.0;  ///< px, axes included
  std::vector<Panel> panels;
};

}  // namespace fatmc::plot
