#include "campaigns/formulas/formula_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include "campaigns/formulas/design_tables.h"
#include "campaigns/formulas/lightly_damped.h"
#include "campaigns/formulas/printed_row.h"
#include "campaigns/formulas/published.h"
#include "core/ident/design_formulas.h"
#include "core/ident/interpolation_bias.h"
#include "core/ident/line_averages.h"

namespace fatmc {
namespace {

using formulas::Printed;

using formulas::add_printed;
using formulas::in_last_digits;

void add_table_2_1(std::vector<TableRow>& rows) {
  for (const formulas::EtfeBiasRow& row : formulas::kTable21) {
    const std::string name = "SNR " + std::string(row.name);
    // "3.1" stands for sqrt(10): only that gives its decibels and both of its biases.
    const bool ten = row.snr.value == 3.1;
    const double snr = ten ? std::sqrt(10.0) : row.snr.value;
    add_printed(rows, "2-1", name, "SNR", "", row.snr, snr, "");
    if (ten) {
      rows.back().why = "printed for sqrt(10) = 3.162, cut off";
      add_printed(rows, "2-1", name, "bias, uncorrelated, at the printed SNR", "", row.uncorrelated,
                  std::abs(relative_etfe_bias(row.snr.value, row.snr.value, 0.0)),
                  "the table is computed with sqrt(10), which it prints as 3.1");
    }
    add_printed(rows, "2-1", name, "SNR in dB", "dB", row.decibel, 20.0 * std::log10(snr), "");
    add_printed(rows, "2-1", name, "bias, uncorrelated (2.40)", "", row.uncorrelated,
                std::abs(relative_etfe_bias(snr, snr, 0.0)), "");
    add_printed(rows, "2-1", name, "bias, correlation -1 (2.41 with 1 - rho r)", "", row.correlated,
                std::abs(relative_etfe_bias(snr, snr, -1.0)), "");
    add_printed(rows, "2-1", name, "bias, correlation -1, as printed (2.41)", "", row.correlated,
                std::abs(relative_etfe_bias(snr, snr, -1.0)) - std::abs(relative_etfe_bias(snr, snr, 0.0)),
                "(2.41) leaves out \"1 -\": the table, twice its other column, contains it");
  }
}

void add_table_2_3(std::vector<TableRow>& rows) {
  const std::array<const char*, 3> why = {
      "", "the printed figure is the constant times 0.02^2: the exponent was left at 4",
      "unexplained; the limit is 35/6435"};
  for (std::size_t i = 0; i < formulas::kTable23.size(); ++i) {
    const formulas::OrderRow& row = formulas::kTable23[i];
    const std::string name = "R = " + std::to_string(row.order);
    add_printed(rows, "2-3", name, "alpha, complex fit, many lines", "", row.alpha,
                limit_bias_constant(row.order), why[i]);
    if (row.order == 4) {
      add_printed(rows, "2-3", name, "alpha 0.02^2", "", row.alpha,
                  limit_bias_constant(row.order) * 0.02 * 0.02, "");
    }
  }
}

void add_table_2_4(std::vector<TableRow>& rows) {
  for (const formulas::OrderRow& row : formulas::kTable24) {
    const std::string name = "R = " + std::to_string(row.order);
    add_printed(rows, "2-4", name, "alpha, fit to the magnitude, narrow window", "", row.alpha,
                magnitude_bias_constant(row.order),
                "printed is the largest of simulated windows of finite width, 1 to 2 % below the limit of "
                "narrow ones");
    add_printed(rows, "2-4", name, "alpha, complex fit (what the LPM does)", "", row.alpha,
                limit_bias_constant(row.order),
                "the printed constant is that of a fit to the magnitude: as a bound on the LPM it is 2.7 to "
                "3.7 times too small");
    // T prints no width for its simulations; one width gives all three figures.
    constexpr double kWidth = 0.12;
    const LightlyDamped system(1e-6);
    const std::vector<double> offsets = even_offsets(1001, kWidth);
    const double error =
        std::abs(polynomial_at_centre(system, 0.0, offsets, row.order, FittedPart::magnitude) - 1.0);
    add_printed(rows, "2-4", name, "alpha, fit to the magnitude, window of 0.12 B_3dB", "", row.alpha,
                error / std::pow(kWidth, row.order + 2), "");
  }
}

/// Range of a rounded figure.
std::pair<double, double> rounded(const Printed& p) {
  const double half = 0.5 * p.value / in_last_digits(p, p.value);
  return {p.value - half, p.value + half};
}

/// A figure of Table 3-1 by the rule that reproduces it; where the digits differ, the range that the rounding of f0 and
/// damping leaves.
void add_by_rule(std::vector<TableRow>& rows, const formulas::ModeRow& mode, bool spacing) {
  const double damping = mode.damping.value;
  const auto figure = [&](double f0, double zeta) {
    const double duration = recommended_duration_s(f0, zeta, 2, DurationRule::table_3_1);
    return spacing ? 1.0 / duration : duration;
  };
  const Printed& printed = spacing ? mode.spacing : mode.duration;
  add_printed(rows, "3-1", mode.name, spacing ? "df = 1/T" : "T = 3 pi/(2 zeta f0)", spacing ? "Hz" : "s",
              printed, figure(mode.f0.value, damping), "");
  TableRow& row = rows.back();
  if (mode.bound) {
    formulas::judge_bound(row, spacing, "the formula gives less, with damping 1 for a real pole");
    return;
  }
  if (row.verdict == "exact") return;
  const auto [f_low, f_high] = rounded(mode.f0);
  const auto [z_low, z_high] = mode.real_pole ? std::pair(1.0, 1.0) : rounded(mode.damping);
  std::tie(row.low, row.high) = std::minmax({figure(f_low, z_low), figure(f_high, z_high)});
  const auto [p_low, p_high] = rounded(printed);
  if (p_high >= row.low && p_low <= row.high) {
    row.verdict = "shape";
    row.why = "f0 and damping are printed rounded: the interval is what they leave open";
  } else {
    row.why = "outside what rounded f0 and damping leave open";
  }
}

void add_table_3_1(std::vector<TableRow>& rows) {
  for (const formulas::ModeRow& mode : formulas::kTable31) {
    add_by_rule(rows, mode, false);
    add_by_rule(rows, mode, true);
    if (mode.bound) continue;
    add_printed(rows, "3-1", mode.name, "T = 7/(2 zeta f0), (2.140) corrected", "s", mode.duration,
                recommended_duration_s(mode.f0.value, mode.damping.value, 2, DurationRule::corrected),
                "printed follows 3 pi/(2 zeta f0); (2.140) with B_3dB = 2 zeta f0 in Hz asks for 26 % less");
  }
}

/// Numbers in the text around Figs. 2-17 and 2-35.
void add_numbers_of_figures(std::vector<TableRow>& rows) {
  const std::vector<double> offsets = even_offsets(7, kFigure217Width);
  const LightlyDamped system(kFigure217Damping);
  const double peak = polynomial_at_centre(system, 0.0, offsets, 2, FittedPart::magnitude);
  const std::string window = "R = 2, 7 lines over 0.8 B_3dB";
  add_printed(rows, "Fig. 2-17", window, "peak of a fit to the magnitude", "", formulas::kPeakOfFit, peak,
              "");
  add_printed(rows, "Fig. 2-17", window, "the same in dB", "dB", formulas::kPeakOfFitDb,
              20.0 * std::log10(peak), "");
  add_printed(rows, "Fig. 2-17", window, "error of the fit", "%", formulas::kPeakErrorPercent,
              100.0 * (1.0 - peak), "");
  add_printed(
      rows, "Fig. 2-17", window, "error of a complex fit (what the LPM does)", "%",
      formulas::kPeakErrorPercent, 100.0 * std::abs(polynomial_error(system, 0.0, offsets, 2)),
      "the figure fits the magnitude; the LPM fits the complex response, whose curvature is 8/3 of it");
  constexpr double kError = 0.05, kRelativeSpacing = 0.005;
  add_printed(rows, "Fig. 2-35", "df/f0 = 0.005, error 5 %", "damping that is covered", "",
              formulas::kCoveredDamping, intergrid_covered_damping(kError, kRelativeSpacing, 1.0), "");
}

}  // namespace

std::vector<TableRow> formula_tables() {
  std::vector<TableRow> rows;
  add_table_2_1(rows);
  add_table_2_3(rows);
  add_table_2_4(rows);
  add_table_3_1(rows);
  const std::vector<TableRow> designs = design_tables();
  rows.insert(rows.end(), designs.begin(), designs.end());
  add_numbers_of_figures(rows);
  return rows;
}

}  // namespace fatmc
