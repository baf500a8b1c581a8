#include "coordinator/plot/svg.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "coordinator/plot/axis_scale.h"
#include "coordinator/plot/marks.h"
#include "coordinator/plot/phase_curve.h"

namespace fatmc::plot {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

int count(const std::string& text, const std::string& part) {
  int n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

std::vector<std::string> texts(const std::vector<double>& ticks) {
  std::vector<std::string> out;
  for (const double tick : ticks) out.push_back(tick_text(tick, ticks));
  return out;
}

TEST(Ticks, AreRoundAndInsideTheRange) {
  EXPECT_THAT(texts(linear_ticks({-0.31, 0.52}, 5)), ElementsAre("-0.2", "0", "0.2", "0.4"));
  EXPECT_THAT(texts(linear_ticks({0.0, 1.0}, 4)), ElementsAre("0", "0.5", "1.0"));
  EXPECT_THAT(texts(linear_ticks({-60.0, 20.0}, 5)), ElementsAre("-60", "-40", "-20", "0", "20"));
  EXPECT_THAT(texts(logarithmic_ticks({0.1, 100.0}, 6)), ElementsAre("0.1", "1", "10", "100"));
  EXPECT_THAT(texts(logarithmic_ticks({0.285, 2.9}, 6)), ElementsAre("0.5", "1", "2"));
  EXPECT_THAT(texts(logarithmic_ticks({0.285, 2.9}, 12)),
              ElementsAre("0.3", "0.4", "0.5", "0.6", "0.8", "1", "2"));
  EXPECT_THAT(texts(logarithmic_ticks({2.1, 4.9}, 5)), ElementsAre("3", "4"));
  EXPECT_LE(logarithmic_ticks({1e-12, 1e12}, 6).size(), 13U);
}

TEST(AxisRange, IsSpannedByTheMarksThatCanBeDrawn) {
  Panel panel;
  panel.x.scale = Scale::logarithmic;
  panel.marks = {Line{"", {-1.0, 0.0, 2.0, 8.0}, {1.0, 2.0, 3.0, kNone}}, Band{"", {4.0}, {-5.0}, {7.0}},
                 Rule{"", 100.0}};
  EXPECT_EQ(axis_range(panel, false).low, 2.0);
  EXPECT_EQ(axis_range(panel, false).high, 8.0);
  EXPECT_DOUBLE_EQ(axis_range(panel, true).low, -5.0 - 0.05 * 12.0);
  EXPECT_DOUBLE_EQ(axis_range(panel, true).high, 7.0 + 0.05 * 12.0);
  panel.marks = {Points{"", {3.0}, {4.0}}};
  EXPECT_LT(axis_range(panel, true).low, 4.0);
  EXPECT_GT(axis_range(panel, true).high, 4.0);
  panel.marks.clear();
  EXPECT_LT(axis_range(panel, false).low, axis_range(panel, false).high);
}

TEST(Marks, PutDataWhereTheAxesSay) {
  const AxisScale x({"", Scale::logarithmic, {}, {}}, {1.0, 100.0}, 0.0, 200.0),
      y({}, {0.0, 10.0}, 100.0, 0.0);
  EXPECT_THAT(mark_svg(Line{"", {1.0, 10.0, 100.0}, {0.0, 5.0, 10.0}}, x, y),
              HasSubstr("d=\"M0 100L100 50L200 0\""));
  EXPECT_THAT(mark_svg(Points{"", {10.0}, {2.5}, Hue::red, false}, x, y),
              HasSubstr("class=\"ring s4\" cx=\"100\" cy=\"75\""));
  EXPECT_THAT(mark_svg(Band{"", {1.0, 100.0}, {1.0, 2.0}, {3.0, 4.0}}, x, y),
              HasSubstr("d=\"M0 70L200 60L200 80L0 90Z\""));
  EXPECT_THAT(mark_svg(Bars{"", {1.0, 10.0, 100.0}, {4.0, 0.0}}, x, y),
              HasSubstr("x=\"0\" y=\"60\" width=\"100\" height=\"40\""));
  EXPECT_THAT(mark_svg(Rule{"", 10.0, true}, x, y), HasSubstr("d=\"M100 100L100 0\""));
}

TEST(Marks, DrawABoxWithMedianWhiskersAndOutliers) {
  const AxisScale x({"", Scale::logarithmic, {}, {}}, {1.0, 100.0}, 0.0, 200.0),
      y({}, {0.0, 10.0}, 100.0, 0.0);
  Boxes boxes{"",   {10.0},    {{1.0, 2.0, 5.0, 7.0, 8.0, {9.5}}}, 2.0 * (std::pow(10.0, 0.2) - 1.0),
              true, Hue::green};
  const std::string svg = mark_svg(boxes, x, y);
  EXPECT_THAT(svg, HasSubstr("x=\"80\" y=\"30\" width=\"40\" height=\"50\""));
  EXPECT_THAT(svg, HasSubstr("M80 50L120 50M100 80L100 90M100 30L100 20"));
  EXPECT_THAT(svg, HasSubstr("cx=\"100\" cy=\"5\" r=\"1\""));
  Panel panel;
  panel.x.scale = Scale::logarithmic;
  panel.marks = {boxes};
  EXPECT_NEAR(axis_range(panel, false).low, std::pow(10.0, 0.8), 1e-12);
  EXPECT_DOUBLE_EQ(axis_range(panel, true).high, 9.5 + 0.05 * 8.5);
}

TEST(Marks, BreakWhereAValueHasNoPlace) {
  const AxisScale x({}, {0.0, 4.0}, 0.0, 400.0), y({"", Scale::logarithmic, {}, {}}, {1.0, 10.0}, 100.0, 0.0);
  const std::string line =
      mark_svg(Line{"", {0.0, 1.0, 2.0, 3.0, 4.0}, {1.0, 10.0, kNone, 10.0, -1.0}}, x, y);
  EXPECT_EQ(count(line, "M"), 2);
  EXPECT_THAT(line, Not(HasSubstr("nan")));
  const std::string band = mark_svg(Band{"", {0.0, 1.0, 2.0}, {1.0, 0.0, 1.0}, {2.0, 2.0, kNone}}, x, y);
  EXPECT_EQ(count(band, "M"), 1);
  EXPECT_EQ(mark_svg(Line{"", {1.0}, {kNone}}, x, y), "");
}

TEST(Marks, ThinManyPointsWithoutLosingAPeak) {
  const AxisScale x({}, {0.0, 1.0}, 0.0, 100.0), y({}, {0.0, 1.0}, 100.0, 0.0);
  Line line;
  for (int k = 0; k <= 100000; ++k) {
    line.x.push_back(k / 1e5);
    line.y.push_back(k == 51234 ? 1.0 : 0.25 + 0.1 * (k % 2));
  }
  const std::string svg = mark_svg(line, x, y);
  EXPECT_LT(svg.size(), 8000U);
  EXPECT_THAT(svg, HasSubstr("L51.2 0L"));
}

TEST(Marks, DrawCellsAsDeepAsTheirSharesWithTheFiguresThatAreVisible) {
  Panel panel;
  panel.marks = {Cells{"right", {0.0, 1.0, 2.0}, {0.0, 0.0, 1.0}, {1.0, 0.25, 0.004}, Hue::green}};
  const Range across = axis_range(panel, false);
  EXPECT_EQ(across.low, -0.5);
  EXPECT_EQ(across.high, 2.5);
  panel.x.range = across;
  panel.y.range = Range{-0.5, 1.5};
  const AxisScale x(panel.x, *panel.x.range, 0.0, 300.0), y(panel.y, *panel.y.range, 200.0, 0.0);
  const std::string svg = mark_svg(panel.marks[0], x, y);
  EXPECT_EQ(count(svg, "<rect"), 3);
  EXPECT_THAT(svg, HasSubstr("opacity=\"0.70\" x=\"0\" y=\"100\" width=\"100\" height=\"100\""));
  EXPECT_THAT(svg, HasSubstr(">100</text>"));
  EXPECT_THAT(svg, HasSubstr(">25</text>"));
  EXPECT_EQ(count(svg, "<text"), 2) << "a share below 1 % has its square alone";
}

TEST(Svg, WritesNamesInsteadOfNumbersAndMakesRoomForThem) {
  Figure figure;
  figure.panel_width = 400.0;
  figure.panel_height = 300.0;
  figure.panels.emplace_back();
  Panel& panel = figure.panels.front();
  panel.x = {"answered", Scale::linear, Range{-0.5, 1.5}, {0.0, 1.0}, {"delay", "a < b"}};
  panel.y = {"hidden", Scale::linear, Range{-0.5, 0.5}, {0.0}, {"a very long name of an effect"}};
  panel.marks = {Cells{"", {0.0}, {0.0}, {1.0}}};
  const std::string svg = svg_of(figure);
  for (const char* name : {">delay</text>", ">a &lt; b</text>", ">a very long name of an effect</text>"})
    EXPECT_EQ(count(svg, name), 1) << name;
  EXPECT_EQ(count(svg, "rotate(-90)"), 3) << "both names along x, and the label of y";
  const std::size_t frame = svg.find("class=\"frame\" x=\"");
  ASSERT_NE(frame, std::string::npos);
  EXPECT_GT(std::stod(svg.substr(frame + 17)), 150.0) << "29 letters stand left of the frame";
}

TEST(PhaseCurve, RunsToTheEdgeAndComesBackOnTheOtherSide) {
  const std::vector<double> phase = unwrapped({90.0, 170.0, -170.0, -90.0, 100.0});
  EXPECT_THAT(phase, ElementsAre(90.0, 170.0, 190.0, 270.0, 100.0));
  const Band curve = turns({1.0, 2.0, 3.0, 4.0, 5.0}, phase, phase);
  // The turn of 0: all but the middle of what lies above 180; the turn of 360: what lies above, and its
  // neighbours.
  EXPECT_EQ(curve.x.size(), curve.low.size());
  std::vector<double> finite;
  for (const double value : curve.low) {
    if (std::isfinite(value)) finite.push_back(value);
  }
  EXPECT_THAT(finite, ElementsAre(90.0, 170.0, 190.0, 270.0, 100.0, -190.0, -170.0, -90.0, -260.0));
  const Band all = turns({1.0, 2.0}, {-180.0, -180.0}, {180.0, 180.0});
  EXPECT_EQ(std::count(all.high.begin(), all.high.end(), 180.0), 2);
  EXPECT_TRUE(turns({}, {}, {}).x.empty());
}

TEST(Svg, HoldsEveryPanelAndEachNameOnce) {
  Figure figure;
  figure.title = "a < b & \"c\"";
  figure.columns = 2;
  for (int k = 0; k < 3; ++k) {
    Panel panel;
    panel.title = "panel " + std::to_string(k);
    panel.x.label = "frequency, Hz";
    panel.marks = {Line{"estimate", {1.0, 2.0}, {3.0, 4.0}}, Points{"", {1.0}, {3.0}}};
    figure.panels.push_back(panel);
  }
  const std::string svg = svg_of(figure);
  EXPECT_EQ(svg, svg_of(figure));
  EXPECT_THAT(svg, HasSubstr("<title>a &lt; b &amp; &quot;c&quot;</title>"));
  EXPECT_EQ(count(svg, "<clipPath"), 3);
  EXPECT_EQ(count(svg, ">panel "), 3);
  EXPECT_EQ(count(svg, ">estimate<"), 1);
  EXPECT_THAT(svg, HasSubstr("prefers-color-scheme:dark"));
  EXPECT_THAT(svg, HasSubstr("width=\"688\""));
  EXPECT_EQ(count(svg, "<g"), count(svg, "</g>"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(Svg, InsideAPageRefersToItsOwnPartsAndBringsNoStyle) {
  Figure figure;
  figure.panels.resize(2);
  for (Panel& panel : figure.panels) panel.marks = {Line{"a", {1.0, 2.0}, {3.0, 4.0}}};
  const std::string svg = inline_svg(figure, "coverage-fig-5-4");
  EXPECT_THAT(svg, Not(HasSubstr("<style>")));
  EXPECT_EQ(count(svg, "id=\"coverage-fig-5-4-clip1\""), 1);
  EXPECT_EQ(count(svg, "url(#coverage-fig-5-4-clip1)"), 1);
}

}  // namespace
}  // namespace fatmc::plot
