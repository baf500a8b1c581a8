#include "campaigns/formulas/bode_panels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace fatmc {
namespace {

// Elements that vanish by symmetry are round-off of any size below this.
constexpr double kRoundOff = 1e-9;
constexpr double kGap = std::numeric_limits<double>::quiet_NaN();

double wrapped_deg(std::complex<double> g) {
  const double deg = std::arg(g) * 180.0 / std::numbers::pi;
  return deg > 0.0 ? deg - 360.0 : deg;
}

void add_curve(const std::vector<double>& f, const BodeCurve& curve, BodePanels& out) {
  plot::Line magnitude{curve.name, f, {}, curve.hue, curve.dash};
  plot::Line phase{curve.name, {}, {}, curve.hue, curve.dash};
  double before = kGap;
  for (std::size_t k = 0; k < f.size(); ++k) {
    const std::complex<double> g = curve.response[k];
    const bool vanishes = !(std::abs(g) > kRoundOff);
    magnitude.y.push_back(vanishes ? kGap : 20.0 * std::log10(std::abs(g)));
    const double deg = vanishes ? kGap : wrapped_deg(g);
    if (std::abs(deg - before) > 180.0) {
      phase.x.push_back(f[k]);
      phase.y.push_back(kGap);
    }
    phase.x.push_back(f[k]);
    phase.y.push_back(deg);
    before = deg;
  }
  out.magnitude.marks.emplace_back(std::move(magnitude));
  out.phase.marks.emplace_back(std::move(phase));
}

}  // namespace

BodePanels bode_panels(const std::string& title, const std::vector<double>& frequency_hz,
                       const std::vector<BodeCurve>& curves) {
  BodePanels out;
  out.magnitude.title = title;
  out.magnitude.x = {"", plot::Scale::logarithmic, {}, {}};
  out.magnitude.y.label = "magnitude, dB";
  out.phase.x = {"f, Hz", plot::Scale::logarithmic, {}, {}};
  out.phase.y = {
      "phase, deg", plot::Scale::linear, plot::Range{-360.0, 0.0}, {-360.0, -270.0, -180.0, -90.0, 0.0}};
  for (const BodeCurve& curve : curves) add_curve(frequency_hz, curve, out);
  const auto vanishes = [](const BodeCurve& curve) {
    return std::none_of(curve.response.begin(), curve.response.end(),
                        [](auto g) { return std::abs(g) > kRoundOff; });
  };
  if (std::all_of(curves.begin(), curves.end(), vanishes)) {
    out.magnitude.title += ": zero";
    out.magnitude.y.range = plot::Range{-40.0, 0.0};
  }
  return out;
}

std::vector<std::complex<double>> element(const std::vector<Eigen::Matrix3cd>& matrices, int output,
                                          int input) {
  std::vector<std::complex<double>> out;
  for (const Eigen::Matrix3cd& g : matrices) out.push_back(g(output, input));
  return out;
}

}  // namespace fatmc
