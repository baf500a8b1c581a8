#include <algorithm>

#include "core/flight/effects/kinds.h"

namespace fatmc::effects {
namespace {

EffectChoice servos() { return {"surface", {"aileron", "ruddervator"}}; }

Actuator& servo_of(const EffectArguments& with, Aircraft& a) {
  return with.choice("surface") == "aileron" ? a.aileron : a.ruddervator;
}

void write_delay(const EffectArguments& with, const Trim&, Aircraft&, FlightSetup& setup) {
  setup.path.command_delay_s += with["delay_s"];
}

void write_bandwidth(const EffectArguments& with, const Trim&, Aircraft& a, FlightSetup&) {
  servo_of(with, a).frequency_rad_s *= with["factor"];
}

void write_servo_damping(const EffectArguments& with, const Trim&, Aircraft& a, FlightSetup&) {
  servo_of(with, a).damping *= with["factor"];
}

void write_rate_limit(const EffectArguments& with, const Trim&, Aircraft& a, FlightSetup&) {
  double& own = servo_of(with, a).rate_limit_rad_s;
  own = std::min(own, with["limit_deg_s"] * kDegree);
}

void write_position_limit(const EffectArguments& with, const Trim&, Aircraft& a, FlightSetup&) {
  double& own = servo_of(with, a).position_limit_rad;
  own = std::min(own, with["limit_deg"] * kDegree);
}

void write_backlash(const EffectArguments& with, const Trim&, Aircraft& a, FlightSetup&) {
  const double half = 0.5 * with["width_deg"] * kDegree;
  if (with.choice("surface") == "aileron") {
    a.additional.half_play_rad[0] += half;
  } else {
    a.additional.half_play_rad[1] += half;
    a.additional.half_play_rad[2] += half;
  }
}

void write_dead_zone(const EffectArguments& with, const Trim&, Aircraft& a, FlightSetup& setup) {
  setup.path.dead_zone[with.axis()] += 0.5 * with["width_deg"] * kDegree / a.full_command_rad;
}

void write_effectiveness(const EffectArguments& with, const Trim&, Aircraft& a, FlightSetup&) {
  const double factor = with["factor"];
  switch (with.axis()) {
    case 0:
      for (LateralDerivatives* c : {&a.side, &a.roll, &a.yaw}) c->xi *= factor;
      break;
    case 1:
      for (LongitudinalDerivatives* c : {&a.lift, &a.pitch}) c->eta *= factor;
      break;
    default:
      for (LateralDerivatives* c : {&a.side, &a.roll, &a.yaw}) c->zeta *= factor;
  }
}

void write_surface_bias(const EffectArguments& with, const Trim&, Aircraft& a, FlightSetup& setup) {
  setup.path.command_offset[with.axis()] += with["bias_deg"] * kDegree / a.full_command_rad;
}

void write_loss(const EffectArguments& with, const Trim&, Aircraft& a, FlightSetup&) {
  const std::string_view surface = with.choice("surface");
  const std::size_t i = surface == "aileron" ? 0 : surface == "left_ruddervator" ? 1 : 2;
  double& what =
      with.choice("failure") == "stuck" ? a.additional.servo_drive[i] : a.additional.surface_share[i];
  what *= 1.0 - with["share"];
}

void write_loop_gain(const EffectArguments& with, const Trim&, Aircraft&, FlightSetup& setup) {
  setup.gain[static_cast<Eigen::Index>(with.axis())] *= with["factor"];
}

void write_turn_coordinator(const EffectArguments& with, const Trim&, Aircraft&, FlightSetup& setup) {
  setup.path.turn_coordinator *= with["factor"];
}

}  // namespace

std::vector<EffectKind> actuation_kinds() {
  EffectParameter coordinator = factor("on its rate command", 0.3, 0.7, -5.0, 5.0);
  coordinator.logarithmic = false;
  coordinator.mirror = EffectParameter::Mirror::difference;
  return {
      {.id = "transport_delay",
       .title = "transport delay",
       .physics = "The servos see each command delay_s later; any delay, not whole ticks alone. Phase -2 pi "
                  "f delay in all elements.",
       .parameters = {size("delay_s", "s", "between controller and servos", 0.01, 0.05, 2.0)},
       .write = write_delay},
      {.id = "actuator_bandwidth",
       .title = "bandwidth of a servo",
       .physics = "The servo's natural frequency is larger or smaller by the factor: d2x/dt2 = w^2 (x_c - x) "
                  "- 2 d w dx/dt.",
       .choices = {servos()},
       .parameters = {factor("frequency over the model's", 0.4, 0.75, 0.05, 20.0)},
       .in_linear_airframe = true,
       .write = write_bandwidth},
      {.id = "actuator_damping",
       .title = "damping of a servo",
       .physics = "The servo's damping ratio d is larger or smaller by the factor.",
       .choices = {servos()},
       .parameters = {factor("damping over the model's", 0.4, 0.7, 0.05, 20.0)},
       .in_linear_airframe = true,
       .write = write_servo_damping},
      {.id = "rate_limit",
       .title = "slow servo (rate limit)",
       .physics =
           "|dx/dt| of the servo stays below the limit: lag and loss that grow with level and frequency.",
       .choices = {servos()},
       .parameters = {limit("limit_deg_s", "deg/s", "of the surface's rate", 1e4, 3.0, 7.0, 0.1)},
       .write = write_rate_limit},
      {.id = "position_limit",
       .title = "short travel (position saturation)",
       .physics = "The surface stops at +-limit: loss of gain at large level.",
       .choices = {servos()},
       .parameters = {limit("limit_deg", "deg", "of the deflection, either side of zero", 90.0, 0.6, 1.2,
                            0.1)},
       .write = write_position_limit},
      {.id = "backlash",
       .title = "backlash of a linkage",
       .physics = "Play between servo and surface: the surface stands still until the servo has crossed the "
                  "width, then follows it half a "
                  "width behind. Loss and lag at small level.",
       .choices = {servos()},
       .parameters = {size("width_deg", "deg", "whole play", 0.2, 0.8, 20.0)},
       .write = write_backlash},
      {.id = "dead_zone",
       .title = "dead zone of the command",
       .physics = "Commands that ask for less than half the width are lost, larger ones are smaller by it: u "
                  "-> u - sign(u) d outside "
                  "|u| <= d, counted from trim. Loss at small level, no lag.",
       .choices = {axes()},
       .parameters = {size("width_deg", "deg", "whole zone, as deflection", 0.2, 0.8, 20.0)},
       .write = write_dead_zone},
      {.id = "control_effectiveness",
       .title = "effectiveness of a control",
       .physics = "All forces and moments per deflection of aileron (roll), symmetric (pitch) or "
                  "antisymmetric (yaw) ruddervator are larger "
                  "or smaller by the factor.",
       .choices = {axes()},
       .parameters = {factor("effectiveness over the model's", 0.7, 0.92, 0.05, 20.0)},
       .in_linear_airframe = true,
       .write = write_effectiveness},
      {.id = "surface_bias",
       .title = "rigging error of a surface",
       .physics = "A servo's zero is off: the command of an undeflected surface is bias. Flown as before, "
                  "since the pilot trims it away; the "
                  "mean command shows it.",
       .choices = {axes()},
       .parameters = {signed_difference("bias_deg", "deg", "command of the neutral surface", 0.3, 1.5, 20.0)},
       .changes_in_flight = false,
       .write = write_surface_bias},
      {.id = "surface_loss",
       .title = "loss of a surface",
       .physics = "stuck: the servo loses the share of its drive (1: it stops where it is). floating: the "
                  "surface loses the share of its "
                  "effect (1: the air sees it undeflected). Usually with an onset.",
       .choices = {{"surface", {"aileron", "left_ruddervator", "right_ruddervator"}},
                   {"failure", {"stuck", "floating"}}},
       .parameters = {size("share", "1", "lost", 0.3, 1.0, 1.0)},
       .write = write_loss},
      {.id = "loop_gain",
       .title = "gain of the rate controller",
       .physics = "The controller's gain of an axis is larger or smaller by the factor than the record says: "
                  "u = factor K (r - y).",
       .choices = {axes()},
       .parameters = {factor("gain over the stated one", 0.7, 0.92, 0.05, 20.0)},
       .write = write_loop_gain},
      {.id = "turn_coordinator",
       .title = "turn coordinator",
       .physics = "The yaw rate command of the turn coordinator (g/V) sin(phi) cos(theta) is multiplied by "
                  "the factor; 0 switches it off.",
       .parameters = {coordinator},
       .write = write_turn_coordinator},
  };
}

}  // namespace fatmc::effects
