#include <array>

#include "core/flight/effects/kinds.h"

namespace fatmc::effects {
namespace {

void write_mass(const EffectArguments& with, const Trim&, Aircraft& a, FlightSetup&) {
  a.mass_kg *= with["factor"];
}

void write_inertia(const EffectArguments& with, const Trim&, Aircraft& a, FlightSetup&) {
  const std::array<double, 3> own = {a.ixx_kg_m2, a.iyy_kg_m2, a.izz_kg_m2};
  const std::size_t i = with.axis();
  a.apparent_inertia_kg_m2[i] += (with["factor"] - 1.0) * (own[i] + a.apparent_inertia_kg_m2[i]);
}

void write_cg_shift(const EffectArguments& with, const Trim&, Aircraft& a, FlightSetup&) {
  a.additional.reference_point_m[with.choice("direction") == "forward" ? 0 : 2] -= with["shift_m"];
}

void write_airspeed(const EffectArguments& with, const Trim&, Aircraft& a, FlightSetup& setup) {
  a.speed_m_s *= with["factor"];
  setup.path.airspeed_reading /= with["factor"];
}

void write_gyroscopics(const EffectArguments& with, const Trim&, Aircraft& a, FlightSetup&) {
  a.additional.rotor_inertia_kg_m2 += with["inertia_kg_m2"];
}

void write_thrust_line(const EffectArguments& with, const Trim&, Aircraft& a, FlightSetup&) {
  a.propulsion.offset_m += with["shift_m"];
}

void write_roll_to_yaw(const EffectArguments& with, const Trim&, Aircraft& a, FlightSetup&) {
  a.yaw.xi += with["ratio"] * a.roll.xi;
}

void write_yaw_to_roll(const EffectArguments& with, const Trim&, Aircraft& a, FlightSetup&) {
  a.roll.zeta += with["ratio"] * a.yaw.zeta;
}

/// A derivative whose factor is an effect.
struct Derivative {
  std::string_view id, title, physics;
  double& (*of)(Aircraft&);
};

constexpr std::array<Derivative, 12> kDerivatives = {{
    {"lift_slope", "lift slope C_L_alpha",
     "C_L_alpha is larger or smaller by the factor. It moves trim and short period.",
     [](Aircraft& a) -> double& { return a.lift.alpha; }},
    {"drag", "zero-lift drag C_D0",
     "C_D0 is larger or smaller by the factor. It moves throttle and the phugoid's damping.",
     [](Aircraft& a) -> double& { return a.drag_zero; }},
    {"cm_alpha", "static stability C_m_alpha",
     "C_m_alpha is larger or smaller by the factor. It sets the short period's frequency and moves trim.",
     [](Aircraft& a) -> double& { return a.pitch.alpha; }},
    {"cm_q", "pitch damping C_m_q",
     "C_m_q is larger or smaller by the factor. It sets the short period's damping.",
     [](Aircraft& a) -> double& { return a.pitch.q; }},
    {"cl_p", "roll damping C_l_p", "C_l_p is larger or smaller by the factor. It sets the roll mode.",
     [](Aircraft& a) -> double& { return a.roll.p; }},
    {"cl_beta", "dihedral effect C_l_beta",
     "C_l_beta is larger or smaller by the factor. It couples side-slip into roll, at the Dutch roll and the "
     "spiral.",
     [](Aircraft& a) -> double& { return a.roll.beta; }},
    {"cl_r", "rolling moment of yaw rate C_l_r",
     "C_l_r is larger or smaller by the factor. It acts on the spiral.",
     [](Aircraft& a) -> double& { return a.roll.r; }},
    {"cn_beta", "weathercock stability C_n_beta",
     "C_n_beta is larger or smaller by the factor. It sets the Dutch roll's frequency.",
     [](Aircraft& a) -> double& { return a.yaw.beta; }},
    {"cn_r", "yaw damping C_n_r",
     "C_n_r is larger or smaller by the factor. It sets the Dutch roll's damping.",
     [](Aircraft& a) -> double& { return a.yaw.r; }},
    {"cn_p", "yawing moment of roll rate C_n_p",
     "C_n_p is larger or smaller by the factor. It couples roll into the Dutch roll.",
     [](Aircraft& a) -> double& { return a.yaw.p; }},
    {"cy_beta", "side force of side-slip C_Y_beta",
     "C_Y_beta is larger or smaller by the factor. It acts on the Dutch roll's damping.",
     [](Aircraft& a) -> double& { return a.side.beta; }},
    {"lift_of_elevator", "lift of the elevator C_L_eta",
     "C_L_eta is larger or smaller by the factor: the tail's lift without its moment. It moves the zeros of "
     "q/eta_c.",
     [](Aircraft& a) -> double& { return a.lift.eta; }},
}};

void write_derivative(const EffectArguments& with, const Trim&, Aircraft& a, FlightSetup&) {
  for (const Derivative& d : kDerivatives) {
    if (d.id == with.kind().id) d.of(a) *= with["factor"];
  }
}

}  // namespace

std::vector<EffectKind> airframe_kinds() {
  std::vector<EffectKind> out = {
      {.id = "mass",
       .title = "mass",
       .physics = "The aircraft weighs m' = factor m; a payload at the centre of gravity, moments of inertia "
                  "unchanged. It "
                  "trims at C_L' = factor C_L: another angle of attack, elevator and throttle.",
       .parameters = {factor("mass over the model's", 0.8, 0.92, 0.3, 3.0)},
       .in_linear_airframe = true,
       .write = write_mass},
      {.id = "inertia",
       .title = "moment of inertia",
       .physics = "The effective moment of inertia of an axis, body and the air it moves (apparent inertia), "
                  "is larger or smaller by "
                  "the factor: dw/dt = I^-1 (M - w x I w). Response above the modes goes with 1/I.",
       .choices = {axes()},
       .parameters = {factor("inertia over the model's", 0.7, 0.92, 0.3, 3.0)},
       .in_linear_airframe = true,
       .write = write_inertia},
      {.id = "cg_shift",
       .title = "centre of gravity elsewhere",
       .physics =
           "The centre of gravity lies shift_m forward of (or below) where the model has it. With r_A = "
           "-shift from it to the "
           "point the derivatives refer to, M = M_A + r_A x F and the inflow is that at A, v + w x r_A: "
           "static margin, "
           "damping and trim follow. Moments of inertia are kept (they change with the square of the shift).",
       .choices = {{"direction", {"forward", "down"}}},
       .parameters = {signed_difference("shift_m", "m", "of the centre of gravity", 0.004, 0.012, 0.2)},
       .in_linear_airframe = true,
       .write = write_cg_shift},
      {.id = "airspeed_error",
       .title = "airspeed reads wrong",
       .physics =
           "The air data read V; the aircraft flies at factor V, trimmed there (position error of the static "
           "source). All "
           "aerodynamic forces go with V^2, damping with V; the recorded V still reads the model's speed.",
       .parameters = {factor("true over indicated airspeed", 0.88, 0.96, 0.6, 1.6)},
       .changes_in_flight = false,
       .in_linear_airframe = true,
       .write = write_airspeed},
      {.id = "propeller_gyroscopics",
       .title = "gyroscopic moment of the propeller",
       .physics = "A propeller of inertia J that turns n times a second (J > 0: clockwise seen from behind) "
                  "has h = 2 pi n J along "
                  "x_b; M = -w x (h, 0, 0) = (0, -r h, q h) couples pitch and yaw with opposite signs.",
       .parameters = {signed_difference("inertia_kg_m2", "kg m^2", "of the turning parts", 0.002, 0.008, 0.5)},
       .in_linear_airframe = true,
       .write = write_gyroscopics},
      {.id = "thrust_line",
       .title = "thrust line elsewhere",
       .physics = "Thrust acts shift_m higher: M_y = -(offset + shift) T. It moves the elevator's trim and "
                  "couples speed into pitch.",
       .parameters = {signed_difference("shift_m", "m", "upwards", 0.02, 0.06, 0.5)},
       .in_linear_airframe = true,
       .write = write_thrust_line},
      {.id = "roll_to_yaw_coupling",
       .title = "aileron yaws",
       .physics = "Adverse (ratio < 0) or proverse yaw of the ailerons: C_n_xi += ratio C_l_xi.",
       .parameters = {signed_difference("ratio", "1", "added yawing over rolling moment of the aileron", 0.03,
                                        0.1, 2.0)},
       .in_linear_airframe = true,
       .write = write_roll_to_yaw},
      {.id = "yaw_to_roll_coupling",
       .title = "rudder rolls",
       .physics = "The fin's side force acts above or below the axis: C_l_zeta += ratio C_n_zeta.",
       .parameters = {signed_difference("ratio", "1", "added rolling over yawing moment of the rudder", 0.5,
                                        1.5, 10.0)},
       .in_linear_airframe = true,
       .write = write_yaw_to_roll},
  };
  for (const Derivative& d : kDerivatives) {
    out.push_back({.id = d.id,
                   .title = d.title,
                   .physics = d.physics,
                   .parameters = {factor("derivative over the model's", 0.7, 0.9, 0.05, 20.0)},
                   .in_linear_airframe = true,
                   .write = write_derivative});
  }
  return out;
}

}  // namespace fatmc::effects
