#include "coordinator/plot/svg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "coordinator/plot/axis_scale.h"
#include "coordinator/plot/marks.h"
#include "core/base/check.h"

namespace fatmc::plot {
namespace {

constexpr double kLeft = 58.0, kRight = 14.0, kTop = 22.0, kBottom = 20.0, kLabel = 16.0, kEdge = 8.0;
constexpr double kCharacter = 6.4;  // mean width of a letter at 12 px, generous

struct Colours {
  const char* light;
  const char* dark;
};
// After Okabe & Ito's palette, darkened on white and lightened on black to a contrast of 4.5 and more for the
// text-like.
constexpr std::array<Colours, 6> kHues = {{{"#0068a8", "#63b3ed"},
                                           {"#b35900", "#f0a04b"},
                                           {"#00795a", "#4cc9a0"},
                                           {"#8a3d86", "#d9a0d6"},
                                           {"#b3261e", "#ff8a80"},
                                           {"#5f6368", "#a8adb3"}}};

std::string text_at(double x, double y, const std::string& classes, const std::string& text) {
  return "<text class=\"" + classes + "\" x=\"" + px(x) + "\" y=\"" + px(y) + "\">" + escaped(text) +
         "</text>\n";
}

std::string segment(const char* kind, double x1, double y1, double x2, double y2) {
  return "<path class=\"" + std::string(kind) + "\" d=\"M" + px(x1) + " " + px(y1) + "L" + px(x2) + " " +
         px(y2) + "\"/>\n";
}

struct Box {
  double left, top, right, bottom;
};

std::string grid(const AxisScale& x, const AxisScale& y, const Box& box) {
  std::string out;
  for (const double v : x.fine_grid()) out += segment("fine", x.pixel(v), box.top, x.pixel(v), box.bottom);
  for (const double v : y.fine_grid()) out += segment("fine", box.left, y.pixel(v), box.right, y.pixel(v));
  for (const double v : x.ticks()) out += segment("grid", x.pixel(v), box.top, x.pixel(v), box.bottom);
  for (const double v : y.ticks()) out += segment("grid", box.left, y.pixel(v), box.right, y.pixel(v));
  return out;
}

/// Letters of UTF-8 text: bytes that do not continue one.
double letters(const std::string& text) {
  return static_cast<double>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

/// Room that the labels of an axis need beside it.
double label_room(const Axis& axis) {
  double longest = 0.0;
  for (const std::string& label : axis.tick_labels) longest = std::max(longest, letters(label));
  return 1.15 * kCharacter * longest + 8.0;  // labels in capitals or of wide letters, too
}

std::string upright(double x, double y, const std::string& text) {
  return "<text class=\"e\" transform=\"translate(" + px(x) + " " + px(y) + ") rotate(-90)\">" +
         escaped(text) + "</text>\n";
}

std::string tick_texts(const Panel& panel, const AxisScale& x, const AxisScale& y, const Box& box) {
  std::string out;
  double free_from =
      box.left - kLeft;  // texts of a crowded logarithmic axis are left out rather than overprinted
  for (std::size_t k = 0; k < x.ticks().size(); ++k) {
    const double v = x.ticks()[k];
    const std::string& text = x.texts()[k];
    if (!panel.x.tick_labels.empty()) {
      out += upright(x.pixel(v) + 4.0, box.bottom + 5.0, text);
      continue;
    }
    const double half = kCharacter * static_cast<double>(text.size()) / 2.0;
    if (x.pixel(v) - half < free_from) continue;
    out += text_at(x.pixel(v), box.bottom + 14.0, "m", text);
    free_from = x.pixel(v) + half + 4.0;
  }
  for (std::size_t k = 0; k < y.ticks().size(); ++k)
    out += text_at(box.left - 5.0, y.pixel(y.ticks()[k]) + 4.0, "e", y.texts()[k]);
  return out;
}

std::string panel_svg(const Panel& panel, double left, double top, double width, double height,
                      const std::string& clip) {
  const bool named_x = !panel.x.tick_labels.empty(), named_y = !panel.y.tick_labels.empty();
  const double below = named_x ? label_room(panel.x) : kBottom;
  const Box box{left + (named_y ? label_room(panel.y) + kLabel : kLeft), top + kTop, left + width - kRight,
                top + height - below - (panel.x.label.empty() ? 0.0 : kLabel)};
  FATMC_CHECK(box.right > box.left && box.bottom > box.top, "a panel larger than its axes");
  const AxisScale x(panel.x, axis_range(panel, false), box.left, box.right),
      y(panel.y, axis_range(panel, true), box.bottom, box.top);
  const std::string rectangle = "x=\"" + px(box.left) + "\" y=\"" + px(box.top) + "\" width=\"" +
                                px(box.right - box.left) + "\" height=\"" + px(box.bottom - box.top) + "\"/>";
  std::string out = "<clipPath id=\"" + clip + "\"><rect " + rectangle + "</clipPath>\n" + grid(x, y, box);
  out += "<g clip-path=\"url(#" + clip + ")\">\n";
  for (const Mark& mark : panel.marks) out += mark_svg(mark, x, y);
  out += "</g>\n<rect class=\"frame\" " + rectangle + "\n" + tick_texts(panel, x, y, box);
  if (!panel.title.empty()) out += text_at(box.left, top + kTop - 6.0, "b", panel.title);
  if (!panel.x.label.empty())
    out += text_at((box.left + box.right) / 2.0, box.bottom + below + 10.0, "m n", panel.x.label);
  if (!panel.y.label.empty()) {
    const double middle = (box.top + box.bottom) / 2.0;
    out += "<text class=\"m n\" transform=\"translate(" + px(left + 14.0) + " " + px(middle) +
           ") rotate(-90)\">" + escaped(panel.y.label) + "</text>\n";
  }
  return out;
}

/// The first mark of each name, in the order of the panels; rows as wide as the figure. Sets `height`.
std::string legend(const Figure& figure, double top, double width, double& height) {
  std::vector<const Mark*> entries;
  for (const Panel& panel : figure.panels) {
    for (const Mark& mark : panel.marks) {
      const auto known = [&](const Mark* other) { return name_of(*other) == name_of(mark); };
      if (!name_of(mark).empty() && std::none_of(entries.begin(), entries.end(), known))
        entries.push_back(&mark);
    }
  }
  height = 0.0;
  if (entries.empty()) return "";
  std::string out;
  double x = kEdge, y = top + 12.0;
  for (const Mark* entry : entries) {
    const double wide = 24.0 + kCharacter * letters(name_of(*entry)) + 16.0;
    if (x > kEdge && x + wide > width) {
      x = kEdge;
      y += 18.0;
    }
    out += legend_sample(*entry, x, y) + text_at(x + 24.0, y + 4.0, "", name_of(*entry));
    x += wide;
  }
  height = y - top + 12.0;
  return out;
}

std::string document(const Figure& figure, const std::string& style, const std::string& id) {
  FATMC_CHECK(figure.columns >= 1 && !figure.panels.empty(), "a grid of panels");
  const int rows = (static_cast<int>(figure.panels.size()) + figure.columns - 1) / figure.columns;
  // A title or a note that is longer than the panels are wide is not cut off.
  const double width = std::max({figure.columns * figure.panel_width + kEdge,
                                 1.4 * kCharacter * letters(figure.title) + 2.0 * kEdge,
                                 kCharacter * letters(figure.note) + 2.0 * kEdge});
  double top = kEdge;
  std::string body;
  if (!figure.title.empty()) {
    body += text_at(kEdge, top + 14.0, "h", figure.title);
    top += 22.0;
  }
  if (!figure.note.empty()) {
    body += text_at(kEdge, top + 11.0, "n", figure.note);
    top += 18.0;
  }
  double legend_height = 0.0;
  body += legend(figure, top, width, legend_height);
  top += legend_height;
  for (std::size_t k = 0; k < figure.panels.size(); ++k) {
    const auto row = static_cast<int>(k) / figure.columns, column = static_cast<int>(k) % figure.columns;
    body += panel_svg(figure.panels[k], column * figure.panel_width, top + row * figure.panel_height,
                      figure.panel_width, figure.panel_height, id + "clip" + std::to_string(k));
  }
  const std::string w = px(width), h = px(top + rows * figure.panel_height + kEdge);
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + w + "\" height=\"" + h + "\" viewBox=\"0 0 " +
         w + " " + h + "\" role=\"img\">\n<title>" + escaped(figure.title) + "</title>\n" + style +
         "<rect class=\"ground\" width=\"" + w + "\" height=\"" + h + "\"/>\n" + body + "</svg>\n";
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        if (static_cast<unsigned char>(c) >= 0x20) out += c;  // control characters are no XML
    }
  }
  return out;
}

std::string svg_style() {
  std::string out =
      "text{font:12px system-ui,'DejaVu Sans',sans-serif;fill:#202124}\n"
      ".h{font-size:14px;font-weight:600}.b{font-weight:600}.m{text-anchor:middle}.c{font-size:10px}.e{text-"
      "anchor:end}.n{fill:"
      "#5f6368}\n"
      ".ground{fill:#ffffff}.frame{fill:none;stroke:#80868b}.grid{fill:none;stroke:#dadce0}.fine{fill:none;"
      "stroke:#eeeff1}\n"
      ".line{fill:none;stroke-width:1.5;stroke-linejoin:round}.thin{fill:none;stroke-width:1}.band{opacity:."
      "25}.bar{opacity:.6}\n"
      ".ring{fill:none;stroke-width:1.2}.dash{stroke-dasharray:6 4}.dot{stroke-dasharray:1.5 3}\n";
  std::string dark;
  for (std::size_t k = 0; k < kHues.size(); ++k) {
    const std::string number = std::to_string(k);
    out += ".s" + number + "{stroke:" + kHues[k].light + "}.f" + number + "{fill:" + kHues[k].light + "}\n";
    dark += ".s" + number + "{stroke:" + kHues[k].dark + "}.f" + number + "{fill:" + kHues[k].dark + "}\n";
  }
  return out +
         "@media (prefers-color-scheme:dark){\n"
         "text{fill:#e8eaed}.n{fill:#a8adb3}.ground{fill:#17181a}.frame{stroke:#80868b}.grid{stroke:#3c4043}."
         "fine{stroke:#2a2c2f}\n"
         ".band{opacity:.35}\n" +
         dark + "}\n";
}

std::string svg_of(const Figure& figure) {
  return document(figure, "<style>\n" + svg_style() + "</style>\n", "");
}

std::string inline_svg(const Figure& figure, const std::string& id) { return document(figure, "", id + "-"); }

}  // namespace fatmc::plot
