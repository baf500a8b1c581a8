// Figs. 3-2, A-1, A-4, A-5, A-6.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "campaigns/formulas/aircraft_formulas.h"
#include "campaigns/formulas/bode_panels.h"
#include "campaigns/formulas/figure_parts.h"
#include "core/flight/closed_rate_loop.h"
#include "core/flight/flight.h"

namespace fatmc {
namespace {

constexpr double kGain = 0.5;  // s/rad, chapters 3 and 4

std::vector<Eigen::Matrix3cd> responses(const LinearModel& model, const std::vector<double>& frequency_hz) {
  std::vector<Eigen::Matrix3cd> out;
  for (const double f : frequency_hz) out.push_back(model.response(f));
  return out;
}

std::string element_name(int output, int input, const char* prefix) {
  static constexpr const char* kOutputs[] = {"p", "q", "r"};
  static constexpr const char* kCommands[] = {"ξ_c", "η_c", "ζ_c"};
  static constexpr const char* kReferences[] = {"p_c", "q_c", "r_c"};
  const bool loop = std::string(prefix) == "loop";
  return std::string(kOutputs[output]) + " / " + (loop ? kReferences[input] : kCommands[input]);
}

StudyFigure primary_responses(const Flight& flight) {
  const std::vector<double> f = logarithmic_steps(0.01, 10.0, 300);
  const auto g = responses(flight.sampled(), f);
  StudyFigure out{
      "Fig. 3-2",
      "Sampled response G0 of the primary pairs, linearised in level flight at the trim speed; dashed: modes "
      "(PH phugoid, SP short period, DR Dutch roll, RM roll) and the zero of the yaw response (ZR).",
      {}};
  out.figure.title = "Primary responses and their modes";
  out.figure.columns = 3;
  struct Marked {
    const char* name;
    double hz;
  };
  const auto poles = flight.continuous().poles();
  const auto near = [&](double hz) {
    double best = hz;
    double distance = 1e9;
    for (const auto& s : poles) {
      const double own = std::abs(s) / (2.0 * std::numbers::pi);
      if (std::abs(std::log(own / hz)) < distance) {
        distance = std::abs(std::log(own / hz));
        best = own;
      }
    }
    return best;
  };
  const std::vector<std::vector<Marked>> marked = {{{"RM", near(2.26)}, {"DR", near(0.329)}},
                                                   {{"PH", near(0.082)}, {"SP", near(0.484)}},
                                                   {{"ZR", 0.05}, {"DR", near(0.329)}}};
  std::vector<plot::Panel> phases;
  for (int i = 0; i < 3; ++i) {
    BodePanels pair =
        bode_panels(element_name(i, i, ""), f, {{"", plot::Hue::blue, plot::Dash::solid, element(g, i, i)}});
    for (const Marked& mode : marked[static_cast<std::size_t>(i)])
      pair.magnitude.marks.emplace_back(plot::Rule{mode.name, mode.hz, true});
    out.figure.panels.push_back(std::move(pair.magnitude));
    phases.push_back(std::move(pair.phase));
  }
  std::move(phases.begin(), phases.end(), std::back_inserter(out.figure.panels));
  return out;
}

/// All nine elements: three rows of magnitudes, each above its row of phases.
plot::Figure matrix_figure(std::string title, const std::vector<double>& f, const char* prefix,
                           const std::vector<std::pair<BodeCurve, std::vector<Eigen::Matrix3cd>>>& curves) {
  plot::Figure out;
  out.title = std::move(title);
  out.columns = 3;
  out.panel_width = 300.0;
  out.panel_height = 150.0;
  for (int i = 0; i < 3; ++i) {
    std::vector<plot::Panel> phases;
    for (int j = 0; j < 3; ++j) {
      std::vector<BodeCurve> own;
      for (const auto& [curve, g] : curves) {
        own.push_back(curve);
        own.back().response = element(g, i, j);
      }
      BodePanels pair = bode_panels(element_name(i, j, prefix), f, own);
      out.panels.push_back(std::move(pair.magnitude));
      phases.push_back(std::move(pair.phase));
    }
    std::move(phases.begin(), phases.end(), std::back_inserter(out.panels));
  }
  return out;
}

StudyFigure linearised_matrix(const Flight& flight) {
  const std::vector<double> f = logarithmic_steps(0.01, 10.0, 200);
  StudyFigure out{
      "Fig. A-1",
      "Linearised frequency response matrix from commands to rates, in level flight: sampled with commands "
      "held "
      "over 0.02 s (G0), and continuous. Elements between longitudinal and lateral motion vanish in level "
      "flight. Phases lie between -360 and 0 degrees.",
      {}};
  out.figure = matrix_figure(
      "Linearised responses G0", f, "",
      {{{"sampled", plot::Hue::blue, plot::Dash::solid, {}}, responses(flight.sampled(), f)},
       {{"continuous", plot::Hue::grey, plot::Dash::dotted, {}}, responses(flight.continuous(), f)}});
  return out;
}

StudyFigure closed_loops(const std::vector<double>& f, const std::vector<Eigen::Matrix3cd>& with,
                         const std::vector<Eigen::Matrix3cd>& without) {
  StudyFigure out{
      "Fig. A-6",
      "Closed loop from reference to measured rates with gain 0.5 s/rad, linearised in level flight, "
      "sampled. "
      "The turn coordinator adds (g/V) sin(φ) cos(θ) to the yaw reference and acts on the roll column alone.",
      {}};
  out.figure = matrix_figure("Closed loop with and without turn coordinator", f, "loop",
                             {{{"without", plot::Hue::blue, plot::Dash::solid, {}}, without},
                              {{"with", plot::Hue::purple, plot::Dash::dashed, {}}, with}});
  return out;
}

StudyFigure coordinator_difference(const std::vector<double>& f, const std::vector<Eigen::Matrix3cd>& with,
                                   const std::vector<Eigen::Matrix3cd>& without) {
  plot::Line magnitude{"", f, {}}, phase{"", f, {}};
  for (std::size_t k = 0; k < f.size(); ++k) {
    const std::complex<double> ratio = with[k](2, 0) / without[k](2, 0);
    magnitude.y.push_back(20.0 * std::log10(std::abs(ratio)));
    phase.y.push_back(std::arg(ratio) * 180.0 / std::numbers::pi);
  }
  StudyFigure out{"Fig. A-5",
                  "Response of r to p_c in the closed loop with turn coordinator, relative to that without: "
                  "gain 0.5 s/rad, "
                  "linearised in level flight, sampled. T's text places the larger part \"from 1 to 10 Hz\"; "
                  "here it lies "
                  "between 1 and 10 rad/s.",
                  {}};
  out.figure.title = "Additional dynamics in r / p_c by the turn coordinator";
  out.figure.columns = 2;
  plot::Panel decibel, degrees;
  decibel.x = degrees.x = {"f, Hz", plot::Scale::logarithmic, {}, {}};
  decibel.y.label = "ratio, dB";
  degrees.y.label = "ratio, deg";
  decibel.marks.emplace_back(std::move(magnitude));
  degrees.marks.emplace_back(std::move(phase));
  out.figure.panels = {std::move(decibel), std::move(degrees)};
  return out;
}

/// Asymptotes: angle random walk N^2, flat, and bias instability B^2/(2 pi f), per Hz. The second is quoted from IEEE Std 952
/// from memory: unverified.
StudyFigure gyro_noise(const AircraftModel& model) {
  constexpr double kDegreesPerHour = 180.0 / std::numbers::pi * 3600.0;
  plot::Panel panel;
  panel.x = {"f, Hz", plot::Scale::logarithmic, {}, {}};
  panel.y = {"PSD, (deg/h)²/Hz", plot::Scale::logarithmic, {}, {}};
  const std::vector<double> f = logarithmic_steps(1e-3, 100.0, 120);
  static constexpr plot::Hue kHues[] = {plot::Hue::blue, plot::Hue::orange, plot::Hue::green,
                                        plot::Hue::purple};
  std::size_t place = 0;
  for (const Imu& imu : model.imus) {
    const plot::Hue hue = kHues[place++ % 4];
    const double walk = std::pow(imu.noise_rad_sqrt_s * kDegreesPerHour, 2);
    const double instability =
        std::pow(std::abs(imu.bias_rad_s[0]) * kDegreesPerHour, 2) / (2.0 * std::numbers::pi);
    plot::Line sum{imu.grade, f, {}, hue}, flat{"", f, {}, hue, plot::Dash::dashed},
        flicker{"", f, {}, hue, plot::Dash::dashed};
    for (const double at : f) {
      flat.y.push_back(walk);
      flicker.y.push_back(instability / at);
      sum.y.push_back(walk + instability / at);
    }
    panel.marks.emplace_back(std::move(flat));
    panel.marks.emplace_back(std::move(flicker));
    panel.marks.emplace_back(std::move(sum));
    panel.marks.emplace_back(plot::Points{"", {instability / walk}, {2.0 * walk}, hue, false, 3.0});
  }
  return one_panel("Fig. A-4", "Noise of the gyros",
                   "Angle random walk (flat) and bias instability (1/f, dashed) of each grade; rings: where "
                   "both are equal. "
                   "Bias instability is taken as the bias of the model, as Tables A-7 and A-8 print the same "
                   "figure; flights "
                   "have a constant bias, no flicker. Quantisation is not part of it. The industrial grade's "
                   "figures are of "
                   "its class, not T's, which prints none.",
                   std::move(panel));
}

}  // namespace

Result<std::vector<StudyFigure>> aircraft_figures(const AircraftModel& model) {
  const auto flight = Flight::prepare(model.aircraft, {});
  if (!flight) return fail(flight.error());
  const std::vector<double> f = logarithmic_steps(0.01, 20.0, 200);
  const Eigen::Vector3d gain = Eigen::Vector3d::Constant(kGain);
  const auto with = responses(closed_rate_loop(*flight, gain, true), f);
  const auto without = responses(closed_rate_loop(*flight, gain, false), f);
  return std::vector<StudyFigure>{primary_responses(*flight), linearised_matrix(*flight), gyro_noise(model),
                                  coordinator_difference(f, with, without), closed_loops(f, with, without)};
}

}  // namespace fatmc
