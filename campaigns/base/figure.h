// What a figure shows, apart from how it is drawn: a grid of panels, each with two axes and marks in the
// data's units.
//
// Studies fill it; coordinator/plot/svg.h draws it. A new kind of mark is a struct here, a member of Mark, and a function
// in coordinator/plot/marks.cc.
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
  /// One a tick, instead of numbers: names of things. Along x they stand upright below the panel.
  std::vector<std::string> tick_labels{};
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
  double radius_px = 2.0;  ///< a ring is 1 px larger
};

/// A histogram: bar i stands on edges[i] ... edges[i + 1], from zero (or the axis' end) to heights[i].
struct Bars {
  std::string name;
  std::vector<double> edges, heights;
  Hue hue = Hue::blue;
};

/// Box plots: box i stands at x[i], from lower to upper quartile with a bar at the median, whiskers to the farthest values
/// within 1.5 interquartile ranges of the box, dots beyond. It is `width` of the axis' unit wide, or reaches from
/// x/(1 + width/2) to x (1 + width/2) where `relative`: equally wide on a logarithmic axis.
struct Boxes {
  struct Box {
    double low_whisker, lower_quartile, median, upper_quartile, high_whisker;
    std::vector<double> outliers;
  };
  std::string name;
  std::vector<double> x;
  std::vector<Box> boxes;
  double width = 1.0;
  bool relative = false;
  Hue hue = Hue::blue;

  [[nodiscard]] double low_edge(double at) const {
    return relative ? at / (1.0 + width / 2.0) : at - width / 2.0;
  }
  [[nodiscard]] double high_edge(double at) const {
    return relative ? at * (1.0 + width / 2.0) : at + width / 2.0;
  }
};

/// The box of a sample; values that are not finite are left out. None where nothing is left.
std::optional<Boxes::Box> box_of(std::vector<double> values);

/// A straight line through the panel at one value of an axis; it does not widen the axis.
struct Rule {
  std::string name;
  double at = 0.0;
  bool vertical = false;
  Hue hue = Hue::grey;
  Dash dash = Dash::dashed;
};

/// Squares of a matrix, each a unit wide and high about its place, as deep in colour as its share (0 to 1), with the share in %
/// from 1 % on. Squares that are not given stay empty.
struct Cells {
  std::string name;
  std::vector<double> x, y, share;
  Hue hue = Hue::blue;
};

using Mark = std::variant<Line, Band, Points, Bars, Boxes, Rule, Cells>;

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
