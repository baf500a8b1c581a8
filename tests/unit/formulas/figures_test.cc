// The figures and tables that need no campaign, held against what is known of them in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "campaigns/formulas/aircraft_formulas.h"
#include "campaigns/formulas/bode_panels.h"
#include "campaigns/formulas/formula_figures.h"
#include "campaigns/formulas/lightly_damped.h"
#include "coordinator/input/toml_file.h"
#include "core/flight/closed_rate_loop.h"
#include "core/ident/design_formulas.h"
#include "core/ident/interpolation_bias.h"

namespace fatmc {
namespace {

AircraftModel fat_model() { return *decode_aircraft_model(*read_toml("campaigns/models/fat.toml")); }

const StudyFigure& find(const std::vector<StudyFigure>& figures, const std::string& id) {
  const auto at =
      std::find_if(figures.begin(), figures.end(), [&](const StudyFigure& f) { return f.id == id; });
  if (at == figures.end()) throw std::runtime_error("no " + id);
  return *at;
}

const plot::Line& line(const StudyFigure& of, std::size_t panel, std::size_t mark) {
  return std::get<plot::Line>(of.figure.panels.at(panel).marks.at(mark));
}

TEST(LightlyDamped, IsOneAtItsPeakAndThreeDecibelsDownAtTheEndsOfItsRange) {
  const LightlyDamped system(1e-4);
  EXPECT_NEAR(std::abs(system.response(0.0)), 1.0, 1e-12);
  EXPECT_NEAR(std::abs(system.response(1.0)), std::sqrt(0.5), 1e-4);
  EXPECT_NEAR(std::abs(system.response(-1.0)), std::sqrt(0.5), 1e-4);
}

TEST(LightlyDamped, ErrorsOfNarrowWindowsTendToTheConstantsInClosedForm) {
  const LightlyDamped system(1e-6);
  const std::vector<double> offsets = even_offsets(2001, 0.02);
  const double scale = std::pow(0.02, -4);
  EXPECT_NEAR(scale * std::abs(polynomial_error(system, 0.0, offsets, 2)) / limit_bias_constant(2), 1.0,
              3e-3);
  EXPECT_NEAR(scale * (1.0 - polynomial_at_centre(system, 0.0, offsets, 2, FittedPart::magnitude)) /
                  magnitude_bias_constant(2),
              1.0, 3e-3);
}

TEST(LightlyDamped, APolynomialThroughAsManyLinesAsCoefficientsMeetsThem) {
  const LightlyDamped system(0.3);
  const std::vector<double> offsets = even_offsets(3, 0.5);
  const std::vector<double> fit = polynomial_values(system, 0.2, offsets, 2, FittedPart::imaginary, offsets);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(fit[i], system.response(0.2 + offsets[i]).imag(), 1e-12);
}

TEST(FormulaFigures, HaveEveryFigureOfThePagesWithoutACampaign) {
  const std::vector<StudyFigure> figures = formula_figures();
  for (const char* id :
       {"Fig. 2-17", "Fig. 2-18", "Fig. 2-19", "Fig. 2-20", "Fig. 2-34", "Fig. 2-35", "Fig. 3-6"}) {
    const StudyFigure& figure = find(figures, id);
    EXPECT_FALSE(figure.caption.empty());
    for (const plot::Panel& panel : figure.figure.panels) EXPECT_FALSE(panel.marks.empty());
  }
}

TEST(FormulaFigures, ConstantOfTheImaginaryPartGrowsWithDampingThatOfTheMagnitudeFalls) {
  const std::vector<StudyFigure> figures = formula_figures();
  const plot::Line& imaginary = line(find(figures, "Fig. 2-19"), 0, 1);
  const plot::Line& magnitude = line(find(figures, "Fig. 2-20"), 0, 1);
  EXPECT_NEAR(imaginary.y.front() / limit_bias_constant(2), 1.0, 0.03);
  EXPECT_NEAR(magnitude.y.front() / magnitude_bias_constant(2), 1.0, 0.03);
  EXPECT_GT(imaginary.y.back(), 1.3 * imaginary.y.front());
  EXPECT_LT(magnitude.y.back(), 0.8 * magnitude.y.front());
  // "The maximum is reached for a centred window" (T, below Fig. 2-20).
  const auto& shifted = std::get<plot::Band>(find(figures, "Fig. 2-20").figure.panels[0].marks[0]);
  const double largest = *std::max_element(shifted.high.begin(), shifted.high.end());
  EXPECT_NEAR(largest, magnitude.y.front(), 1e-3 * largest);
}

TEST(AircraftTables, MeetThePolesOfTableA5ToTheSixDigitsOfTheModelFile) {
  const auto rows = aircraft_tables(fat_model());
  ASSERT_TRUE(rows);
  int poles = 0;
  for (const TableRow& row : *rows) {
    EXPECT_TRUE(row.verdict == "exact" || row.verdict == "shape" || row.verdict == "differs") << row.row;
    EXPECT_TRUE(row.verdict == "exact" || !row.why.empty())
        << row.table << " " << row.row << " " << row.quantity;
    if (row.table != "A-5") continue;
    EXPECT_NEAR(row.value, row.published, 1e-6) << row.row;
    ++poles;
  }
  EXPECT_EQ(poles, 12);
}

TEST(AircraftTables, AnAircraftWithoutLevelFlightIsAnError) {
  AircraftModel model = fat_model();
  model.aircraft.speed_m_s = 2.0;
  EXPECT_FALSE(aircraft_tables(model));
  EXPECT_FALSE(aircraft_figures(model));
}

TEST(AircraftFigures, LoopIsThatOfTheControllerEquationAndTheCoordinatorMovesOneColumn) {
  const auto flight = Flight::prepare(fat_model().aircraft, {});
  ASSERT_TRUE(flight);
  const Eigen::Vector3d gain(0.5, 0.4, 0.3);
  const LinearModel with = closed_rate_loop(*flight, gain, true),
                    without = closed_rate_loop(*flight, gain, false);
  for (const double f : {0.05, 0.5, 3.0}) {
    const Eigen::Matrix3cd g = flight->sampled().response(f);
    const Eigen::Matrix3cd k = gain.asDiagonal().toDenseMatrix().cast<std::complex<double>>();
    const Eigen::Matrix3cd loop = (Eigen::Matrix3cd::Identity() + g * k).inverse() * g * k;
    EXPECT_LT((without.response(f) - loop).norm(), 1e-10 * loop.norm());
    // Rates respond to the yaw reference through phi, too; the pitch column never does.
    const Eigen::Matrix3cd change = with.response(f) - without.response(f);
    EXPECT_GT(std::abs(change(2, 0)), 1e-6);
    EXPECT_LT(change.col(1).norm(), 1e-9);
  }
}

TEST(AircraftFigures, AreThoseOfChapterThreeAndAppendixA) {
  const auto figures = aircraft_figures(fat_model());
  ASSERT_TRUE(figures);
  EXPECT_EQ(find(*figures, "Fig. 3-2").figure.panels.size(), 6U);
  for (const char* id : {"Fig. A-1", "Fig. A-6"}) EXPECT_EQ(find(*figures, id).figure.panels.size(), 18U);
  // The corner of the tactical grade, (6/0.07)^2/(2 pi 3600) Hz, is marked by a ring.
  const auto& marks = find(*figures, "Fig. A-4").figure.panels.at(0).marks;
  const auto& ring = std::get<plot::Points>(marks.at(3));
  EXPECT_NEAR(ring.x.at(0), std::pow(6.0 / 0.07, 2) / (2.0 * M_PI * 3600.0), 1e-9);
}

TEST(BodePanels, BreakThePhaseWhereItJumpsBetweenItsEnds) {
  const std::vector<std::complex<double>> g = {std::polar(1.0, 0.1), std::polar(1.0, -0.1)};
  const BodePanels panels = bode_panels("", {1.0, 2.0}, {{"", plot::Hue::blue, plot::Dash::solid, g}});
  const auto& phase = std::get<plot::Line>(panels.phase.marks.at(0));
  ASSERT_EQ(phase.y.size(), 3U);
  EXPECT_NEAR(phase.y[0], -360.0 + 0.1 * 180.0 / M_PI, 1e-9);
  EXPECT_TRUE(std::isnan(phase.y[1]));
  EXPECT_NEAR(phase.y[2], -0.1 * 180.0 / M_PI, 1e-9);
}

}  // namespace
}  // namespace fatmc
