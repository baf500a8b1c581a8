#include "core/flight/trim.h"

#include <Eigen/Dense>

#include "core/flight/additional_dynamics.h"
#include "core/flight/dual.h"

namespace fatmc {

FlightConstants::FlightConstants(const Aircraft& a)
    : density(isa_density(a.altitude_m)),
      force_scale(0.5 * density * a.wing_area_m2),
      half_span(0.5 * a.span_m),
      half_chord(0.5 * a.chord_m),
      span(a.span_m),
      chord(a.chord_m),
      inverse_mass(1.0 / a.mass_kg),
      ixx(a.ixx_kg_m2 + a.apparent_inertia_kg_m2[0]),
      iyy(a.iyy_kg_m2 + a.apparent_inertia_kg_m2[1]),
      izz(a.izz_kg_m2 + a.apparent_inertia_kg_m2[2]),
      ixz(a.ixz_kg_m2),
      inverse_xx(izz / (ixx * izz - ixz * ixz)),
      inverse_yy(1.0 / iyy),
      inverse_zz(ixx / (ixx * izz - ixz * ixz)),
      inverse_xz(ixz / (ixx * izz - ixz * ixz)),
      lift(a.lift),
      pitch(a.pitch),
      drag_zero(a.drag_zero),
      drag_induced(a.drag_induced),
      side(a.side),
      roll(a.roll),
      yaw(a.yaw),
      thrust_offset(a.propulsion.offset_m),
      stall_torque(a.propulsion.stall_torque_n_m),
      torque_slope(a.propulsion.torque_slope_n_m_s),
      inverse_shaft_inertia(1.0 / (2.0 * kPi * a.propulsion.inertia_kg_m2)),
      inverse_esc(1.0 / a.propulsion.esc_time_constant_s),
      full_command(a.full_command_rad) {
  // rho n^2 D^4 C(u/(n D)) = rho D^4 (c0 n^2 + c1 n u/D + c2 u^2/D^2); torque has one D more.
  double power = density * std::pow(a.propulsion.diameter_m, 4);
  for (std::size_t i = 0; i < 3; ++i) {
    thrust[i] = power * a.propulsion.thrust[i];
    torque[i] = power * a.propulsion.diameter_m * a.propulsion.torque[i];
    power /= a.propulsion.diameter_m;
    const Actuator& servo = i == 0 ? a.aileron : a.ruddervator;
    servo_stiffness[i] = servo.frequency_rad_s * servo.frequency_rad_s * a.additional.servo_drive[i];
    servo_damping[i] = 2.0 * servo.damping * servo.frequency_rad_s;
    position_limit[i] = servo.position_limit_rad;
    rate_limit[i] = servo.rate_limit_rad_s;
    acceleration_limit[i] = servo.acceleration_limit_rad_s2;
  }
}

namespace {

/// dx/dt in still air, with whatever the aircraft has besides the rigid body.
template <typename T>
void slopes(const Aircraft& a, const FlightConstants& k, const State<T>& x, const Demand<T>& demand,
            State<T>& dx) {
  if (a.additional == AdditionalPhysics{}) {
    derivative(k, x, demand, Gust<T>{}, dx);
  } else {
    derivative(k, x, demand, Gust<T>{}, dx, AdditionalDynamics(a, k, false));
  }
}

/// State and demand of level flight with the four unknowns (alpha, eta, throttle, n).
template <typename T>
void place(const Aircraft& a, const std::array<T, 4>& unknown, State<T>& x, Demand<T>& demand) {
  using std::cos;
  using std::sin;
  x = State<T>{};
  const std::array<T, 4> attitude = quaternion_of(T(0.0), unknown[0]);
  std::copy(attitude.begin(), attitude.end(), x.begin());
  x[state::velocity] = a.speed_m_s * cos(unknown[0]);
  x[state::velocity + 2] = a.speed_m_s * sin(unknown[0]);
  x[state::surfaces + 1] = x[state::surfaces + 2] = unknown[1];
  x[state::throttle] = unknown[2];
  x[state::propeller] = unknown[3];
  demand.surfaces = {T(0.0), unknown[1], unknown[1]};
  demand.throttle = unknown[2];
}

}  // namespace

Trim trim_level(const Aircraft& a) {
  using Scalar = Dual<4>;
  constexpr std::array<std::size_t, 4> equations = {state::velocity, state::velocity + 2, state::rates + 1,
                                                    state::propeller};
  constexpr int most_iterations = 50;
  constexpr double tolerance = 1e-11;  // m/s^2 and alike: rounding of sums of about 10
  const FlightConstants k(a);
  Trim trim;
  // Start: lift alone carries the weight; n at an advance ratio of 0.6, half throttle.
  const double needed = a.mass_kg * kGravity / (k.force_scale * a.speed_m_s * a.speed_m_s);
  std::array<double, 4> unknown = {(needed - a.lift.zero) / a.lift.alpha, 0.0, 0.5,
                                   a.speed_m_s / (0.6 * a.propulsion.diameter_m)};
  for (trim.iterations = 0; trim.iterations <= most_iterations; ++trim.iterations) {
    std::array<Scalar, 4> variable;
    for (std::size_t i = 0; i < 4; ++i) variable[i] = Scalar(unknown[i], i);
    State<Scalar> x;
    State<Scalar> dx;
    Demand<Scalar> demand;
    place(a, variable, x, demand);
    slopes(a, k, x, demand, dx);
    Eigen::Vector4d value;
    Eigen::Matrix4d jacobian;
    for (std::size_t i = 0; i < 4; ++i) {
      value[i] = dx[equations[i]].value;
      for (std::size_t j = 0; j < 4; ++j) jacobian(i, j) = dx[equations[i]].slope[j];
    }
    trim.residual = value.cwiseAbs().maxCoeff();
    if (!std::isfinite(trim.residual)) return trim;
    if (trim.residual < tolerance) break;
    if (trim.iterations == most_iterations) return trim;
    const Eigen::Vector4d step = jacobian.fullPivLu().solve(value);
    for (std::size_t i = 0; i < 4; ++i) unknown[i] -= step[i];
  }
  trim.alpha_rad = unknown[0];
  trim.eta_rad = unknown[1];
  trim.throttle = unknown[2];
  trim.propeller_hz = unknown[3];
  place(a, unknown, trim.state, trim.demand);
  const double u = trim.state[state::velocity];
  trim.thrust_n =
      (k.thrust[0] * trim.propeller_hz + k.thrust[1] * u) * trim.propeller_hz + k.thrust[2] * u * u;
  State<double> dx;
  slopes(a, k, trim.state, trim.demand, dx);
  trim.residual = 0.0;
  for (const double slope : dx) trim.residual = std::max(trim.residual, std::abs(slope));
  const bool inside = trim.throttle >= 0.0 && trim.throttle <= 1.0 && trim.propeller_hz > 0.0 &&
                      std::abs(trim.eta_rad) <= a.ruddervator.position_limit_rad &&
                      trim.alpha_rad >= a.validity.alpha_min_rad &&
                      trim.alpha_rad <= a.validity.alpha_max_rad;
  trim.outcome = inside ? Trim::Outcome::converged : Trim::Outcome::outside_model;
  return trim;
}

}  // namespace fatmc
