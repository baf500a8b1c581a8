#include "core/discrepancy/effect_knowledge.h"

#include <algorithm>
#include <iterator>

namespace fatmc {

// Kinds of the library that do not stand here are no candidates: a tone (its frequency is found to a bin only by looking at
// the spectrum), the loss of a surface (a change in flight), and moments of higher order.
const std::vector<EffectKnowledge>& effect_knowledge() {
  static const std::vector<EffectKnowledge> all = {
      {"transport_delay",
       "phase proportional to frequency in all elements",
       {"actuator_bandwidth", "gyro_lag"},
       "lines up to several hertz"},
      {"actuator_bandwidth",
       "phase and roll-off of one servo's columns",
       {"transport_delay", "rate_limit", "actuator_damping"},
       "lines up to several hertz, at two levels"},
      {"actuator_damping",
       "gain and phase near the servo's frequency",
       {"actuator_bandwidth"},
       "lines up to 6 Hz"},
      {"gyro_lag",
       "lag of the rates but not of the attitude",
       {"transport_delay", "actuator_bandwidth"},
       "recorded attitude, noise spectrum of the gyros"},
      {"control_effectiveness",
       "gain of one column",
       {"inertia", "loop_gain", "gyro_scale"},
       "lines below the modes, a second speed, logged deflections"},
      {"inertia",
       "response above the modes with 1/I",
       {"control_effectiveness"},
       "lines below the modes, a second speed"},
      {"mass",
       "lift slope and trim",
       {"airspeed_error", "lift_slope"},
       "mean elevator and pitch attitude, a second speed"},
      {"cg_shift", "short period and trim", {"cm_alpha", "thrust_line"}, "mean elevator at two speeds"},
      {"lift_slope",
       "short period and trim attitude",
       {"mass", "airspeed_error"},
       "mean pitch attitude, a second speed"},
      {"drag", "phugoid and speed", {"airspeed_error"}, "throttle, lines below 0.1 Hz"},
      {"cm_alpha",
       "frequency of the short period, trim",
       {"cg_shift", "cm_q"},
       "mean elevator, lines about the short period"},
      {"cm_q", "damping of the short period", {"cm_alpha"}, "lines about the short period"},
      {"cl_p", "roll mode", {"inertia", "control_effectiveness"}, "lines on both sides of the roll mode"},
      {"cl_beta",
       "roll in the Dutch roll and the spiral",
       {"cn_beta", "cl_r"},
       "lines below 0.3 Hz, steady side-slip"},
      {"cl_r", "spiral", {"cl_beta"}, "lines below 0.1 Hz"},
      {"cn_beta", "frequency of the Dutch roll", {"cn_r", "cl_beta"}, "lines about the Dutch roll"},
      {"cn_r", "damping of the Dutch roll", {"cn_beta", "cy_beta"}, "lines about the Dutch roll"},
      {"cn_p", "yaw in roll", {"roll_to_yaw_coupling"}, "lines about the roll mode"},
      {"cy_beta", "damping of the Dutch roll", {"cn_r"}, "lateral acceleration"},
      {"lift_of_elevator", "zeros of pitch", {"cg_shift"}, "vertical acceleration"},
      {"airspeed_error",
       "all elements, mean attitude",
       {"mass", "lift_slope"},
       "air data from another source, a second speed"},
      {"propeller_gyroscopics",
       "antisymmetric coupling of pitch and yaw",
       {"gyro_misalignment"},
       "another propeller speed"},
      {"thrust_line",
       "elevator trim, speed into pitch",
       {"cg_shift", "surface_bias"},
       "another power setting"},
      {"roll_to_yaw_coupling",
       "the element from aileron to yaw",
       {"gyro_misalignment", "cn_p"},
       "symmetry of the matrix"},
      {"yaw_to_roll_coupling",
       "the element from rudder to roll",
       {"gyro_misalignment"},
       "symmetry of the matrix"},
      {"gyro_scale", "gain of one row", {"control_effectiveness", "loop_gain"}, "recorded attitude"},
      {"gyro_misalignment",
       "rotation of the rows",
       {"roll_to_yaw_coupling", "propeller_gyroscopics"},
       "recorded attitude"},
      {"gyro_bias", "mean rates alone", {"surface_bias"}, "mean attitude and mean command together"},
      {"gyro_noise",
       "spectrum above the response",
       {"gyro_quantisation", "turbulence"},
       "a record without input"},
      {"gyro_quantisation", "values on a lattice", {"gyro_noise"}, "the histogram of the samples"},
      {"turbulence", "noise spectra at low frequency", {"gyro_noise"}, "a record without input"},
      {"surface_bias", "mean command alone", {"gyro_bias", "thrust_line", "cg_shift"}, "logged deflections"},
      {"rate_limit", "lag that grows with level", {"actuator_bandwidth"}, "two levels"},
      {"position_limit", "loss of gain at large level", {"dead_zone"}, "a larger input"},
      {"backlash", "loss and lag at small level", {"dead_zone", "actuator_bandwidth"}, "a smaller input"},
      {"dead_zone", "loss at small level", {"backlash", "control_effectiveness"}, "a smaller input"},
      {"flexible_mode", "a resonance in the rates", {"slosh", "cm_q"}, "lines about the resonance"},
      {"slosh", "a resonance in the body's motion", {"flexible_mode", "cl_p"}, "lines about the resonance"},
      {"loop_gain",
       "the controller's gain in the logged commands",
       {"control_effectiveness"},
       "logged commands"},
      {"turn_coordinator", "bank into the yaw command", {"loop_gain"}, "logged commands and bank"},
  };
  return all;
}

const EffectKnowledge* find_knowledge(std::string_view id) {
  const auto& all = effect_knowledge();
  const auto at = std::find_if(all.begin(), all.end(), [&](const EffectKnowledge& k) { return k.id == id; });
  return at == all.end() ? nullptr : &*at;
}

bool is_derivative(std::string_view id) {
  constexpr std::string_view kDerivatives[] = {"lift_slope", "lift_of_elevator", "drag", "cm_alpha", "cm_q",
                                               "cl_p",       "cl_beta",          "cl_r", "cn_beta",  "cn_r",
                                               "cn_p",       "cy_beta"};
  return std::find(std::begin(kDerivatives), std::end(kDerivatives), id) != std::end(kDerivatives);
}

std::string separating_experiment(const std::vector<std::string>& ids) {
  std::string out;
  std::vector<std::string_view> said;
  for (const std::string& id : ids) {
    const EffectKnowledge* known = find_knowledge(id);
    if (known == nullptr || std::find(said.begin(), said.end(), known->separated_by) != said.end()) continue;
    said.push_back(known->separated_by);
    out += (out.empty() ? "" : "; ") + std::string(known->separated_by);
  }
  return out;
}

}  // namespace fatmc
