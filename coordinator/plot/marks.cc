#include "coordinator/plot/marks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/check.h"
#include "core/base/text.h"

namespace fatmc::plot {
namespace {

struct Pixel {
  double x = 0.0, y = 0.0;
};

std::string class_of(const char* kind, Hue hue) {
  return std::string(kind) + std::to_string(static_cast<int>(hue));
}

std::string dash_class(Dash dash) {
  return dash == Dash::dashed ? " dash" : dash == Dash::dotted ? " dot" : "";
}

/// Far outside the panel the clip hides it; kept short so that no renderer overflows.
double limited(double value) { return std::clamp(value, -1e4, 1e4); }

std::string point(const Pixel& p) { return px(limited(p.x)) + " " + px(limited(p.y)); }

/// Consecutive drawable points, thinned a pixel column.
std::vector<std::vector<Pixel>> runs(const std::vector<double>& x, const std::vector<double>& y,
                                     const AxisScale& sx, const AxisScale& sy) {
  FATMC_CHECK(x.size() == y.size(), "an ordinate an abscissa");
  std::vector<std::vector<Pixel>> out;
  bool open = false;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const Pixel p{sx.pixel(x[k]), sy.pixel(y[k])};
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) {
      open = false;
      continue;
    }
    if (!open) out.emplace_back();
    out.back().push_back(p);
    open = true;
  }
  return out;
}

/// First, lowest, highest and last point of every pixel column, in their order.
std::vector<Pixel> thinned(const std::vector<Pixel>& points) {
  std::vector<Pixel> out;
  for (std::size_t first = 0; first < points.size();) {
    std::size_t last = first, low = first, high = first;
    while (last + 1 < points.size() && std::floor(points[last + 1].x) == std::floor(points[first].x)) {
      ++last;
      if (points[last].y < points[low].y) low = last;
      if (points[last].y > points[high].y) high = last;
    }
    std::array<std::size_t, 4> keep = {first, std::min(low, high), std::max(low, high), last};
    for (std::size_t k = 0; k < keep.size(); ++k) {
      if (k == 0 || keep[k] != keep[k - 1]) out.push_back(points[keep[k]]);
    }
    first = last + 1;
  }
  return out;
}

std::string path_of(const std::vector<Pixel>& points) {
  std::string out;
  for (const Pixel& p : points) out += (out.empty() ? "M" : "L") + point(p);
  return out;
}

struct Drawing {
  const AxisScale& x;
  const AxisScale& y;

  std::string operator()(const Line& m) const {
    std::string path;
    for (const auto& run : runs(m.x, m.y, x, y)) path += path_of(thinned(run));
    if (path.empty()) return "";
    return "<path class=\"line " + class_of("s", m.hue) + dash_class(m.dash) + "\" d=\"" + path + "\"/>\n";
  }
  std::string operator()(const Band& m) const {
    const auto lower = gapped(m.low, m.high), upper = gapped(m.high, m.low);
    const auto low = runs(m.x, lower, x, y), high = runs(m.x, upper, x, y);
    std::string path;
    for (std::size_t k = 0; k < low.size(); ++k) {
      std::vector<Pixel> outline = thinned(high[k]), back = thinned(low[k]);
      outline.insert(outline.end(), back.rbegin(), back.rend());
      path += path_of(outline) + "Z";
    }
    if (path.empty()) return "";
    return "<path class=\"band " + class_of("f", m.hue) + "\" d=\"" + path + "\"/>\n";
  }
  std::string operator()(const Points& m) const {
    std::string out;
    for (const auto& run : runs(m.x, m.y, x, y)) {
      for (const Pixel& p : run) {
        out += "<circle class=\"" + (m.filled ? class_of("f", m.hue) : "ring " + class_of("s", m.hue)) +
               "\" cx=\"" + px(limited(p.x)) + "\" cy=\"" + px(limited(p.y)) + "\" r=\"" +
               px(m.filled ? m.radius_px : m.radius_px + 1.0) + "\"/>\n";
      }
    }
    return out;
  }
  std::string operator()(const Bars& m) const {
    FATMC_CHECK(m.edges.size() == m.heights.size() + 1, "an edge more than bars");
    const double zero = y.pixel(0.0), base = std::isfinite(zero) ? zero : y.pixel(y.range().low);
    std::string out;
    for (std::size_t k = 0; k < m.heights.size(); ++k) {
      const double left = x.pixel(m.edges[k]), right = x.pixel(m.edges[k + 1]), top = y.pixel(m.heights[k]);
      if (!std::isfinite(left) || !std::isfinite(right) || !std::isfinite(top)) continue;
      out += "<rect class=\"bar " + class_of("f", m.hue) + "\" x=\"" + px(limited(std::min(left, right))) +
             "\" y=\"" + px(limited(std::min(top, base))) + "\" width=\"" +
             px(std::abs(limited(right) - limited(left))) + "\" height=\"" +
             px(std::abs(limited(top) - limited(base))) + "\"/>\n";
    }
    return out;
  }
  std::string operator()(const Boxes& m) const {
    FATMC_CHECK(m.x.size() == m.boxes.size(), "a box an abscissa");
    std::string lines, out;
    for (std::size_t k = 0; k < m.x.size(); ++k) {
      const Boxes::Box& box = m.boxes[k];
      const double left = x.pixel(m.low_edge(m.x[k])), right = x.pixel(m.high_edge(m.x[k]));
      const double middle = x.pixel(m.x[k]);
      const double bottom = y.pixel(box.lower_quartile), top = y.pixel(box.upper_quartile);
      if (!std::isfinite(left + right + bottom + top)) continue;
      out += "<rect class=\"bar " + class_of("f", m.hue) + "\" x=\"" + px(limited(left)) + "\" y=\"" +
             px(limited(top)) + "\" width=\"" + px(limited(right) - limited(left)) + "\" height=\"" +
             px(std::max(limited(bottom) - limited(top), 0.5)) + "\"/>\n";
      const double median = y.pixel(box.median);
      lines += path_of({{left, median}, {right, median}});
      for (const auto& [from, to] :
           {std::pair{bottom, y.pixel(box.low_whisker)}, std::pair{top, y.pixel(box.high_whisker)}}) {
        if (std::isfinite(to) && std::abs(to - from) > 0.05) lines += path_of({{middle, from}, {middle, to}});
      }
      out += (*this)(
          Points{"", std::vector<double>(box.outliers.size(), m.x[k]), box.outliers, m.hue, true, 1.0});
    }
    if (lines.empty()) return out;
    return out + "<path class=\"thin " + class_of("s", m.hue) + "\" d=\"" + lines + "\"/>\n";
  }
  std::string operator()(const Rule& m) const {
    const double at = m.vertical ? x.pixel(m.at) : y.pixel(m.at);
    if (!std::isfinite(at)) return "";
    const Pixel from = m.vertical ? Pixel{at, y.pixel(y.range().low)} : Pixel{x.pixel(x.range().low), at};
    const Pixel to = m.vertical ? Pixel{at, y.pixel(y.range().high)} : Pixel{x.pixel(x.range().high), at};
    return "<path class=\"thin " + class_of("s", m.hue) + dash_class(m.dash) + "\" d=\"" +
           path_of({from, to}) + "\"/>\n";
  }
  std::string operator()(const Cells& m) const {
    FATMC_CHECK(m.x.size() == m.y.size() && m.x.size() == m.share.size(), "a share a place");
    std::string squares, texts;
    for (std::size_t k = 0; k < m.x.size(); ++k) {
      const double left = x.pixel(m.x[k] - 0.5), right = x.pixel(m.x[k] + 0.5);
      const double top = y.pixel(m.y[k] + 0.5), bottom = y.pixel(m.y[k] - 0.5);
      if (!std::isfinite(left + right + top + bottom + m.share[k])) continue;
      const double share = std::clamp(m.share[k], 0.0, 1.0);
      squares += "<rect class=\"" + class_of("f", m.hue) + "\" opacity=\"" + fixed(0.08 + 0.62 * share, 2) +
                 "\" x=\"" + px(limited(left)) + "\" y=\"" + px(limited(top)) + "\" width=\"" +
                 px(limited(right) - limited(left)) + "\" height=\"" + px(limited(bottom) - limited(top)) +
                 "\"/>\n";
      if (share < 0.01) continue;
      texts += "<text class=\"m c\" x=\"" + px(limited(0.5 * (left + right))) + "\" y=\"" +
               px(limited(0.5 * (top + bottom)) + 3.5) + "\">" + fixed(100.0 * share, 0) + "</text>\n";
    }
    return squares + texts;
  }

  /// `values`, with gaps where `others` have none to pair with.
  [[nodiscard]] std::vector<double> gapped(std::vector<double> values,
                                           const std::vector<double>& others) const {
    FATMC_CHECK(values.size() == others.size(), "two sides of a band");
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (!std::isfinite(y.pixel(others[k]))) values[k] = others[k];
    }
    return values;
  }
};

struct Sample {
  double x, y;

  std::string operator()(const Line& m) const {
    return "<path class=\"line " + class_of("s", m.hue) + dash_class(m.dash) + "\" d=\"" +
           path_of({{x, y}, {x + 18.0, y}}) + "\"/>";
  }
  std::string operator()(const Band& m) const { return box("band ", m.hue); }
  std::string operator()(const Bars& m) const { return box("bar ", m.hue); }
  std::string operator()(const Cells& m) const { return box("bar ", m.hue); }
  std::string operator()(const Boxes& m) const { return box("bar ", m.hue); }
  std::string operator()(const Points& m) const {
    return "<circle class=\"" + (m.filled ? class_of("f", m.hue) : "ring " + class_of("s", m.hue)) +
           "\" cx=\"" + px(x + 9.0) + "\" cy=\"" + px(y) + "\" r=\"3\"/>";
  }
  std::string operator()(const Rule& m) const {
    return "<path class=\"thin " + class_of("s", m.hue) + dash_class(m.dash) + "\" d=\"" +
           path_of({{x, y}, {x + 18.0, y}}) + "\"/>";
  }
  [[nodiscard]] std::string box(const char* kind, Hue hue) const {
    return "<rect class=\"" + std::string(kind) + class_of("f", hue) + "\" x=\"" + px(x) + "\" y=\"" +
           px(y - 5.0) + "\" width=\"18\" height=\"10\"/>";
  }
};

}  // namespace

std::string px(double value) {
  std::string text = fixed(value, 1);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text == "-0" ? "0" : text;
}

std::string mark_svg(const Mark& mark, const AxisScale& x, const AxisScale& y) {
  return std::visit(Drawing{x, y}, mark);
}

std::string legend_sample(const Mark& mark, double x_px, double y_px) {
  return std::visit(Sample{x_px, y_px}, mark);
}

const std::string& name_of(const Mark& mark) {
  return std::visit([](const auto& m) -> const std::string& { return m.name; }, mark);
}

}  // namespace fatmc::plot
