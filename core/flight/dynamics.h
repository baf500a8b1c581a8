// Equations of motion of the rigid aircraft and their classical Runge-Kutta step, over any scalar.
//
//   m (dv/dt + w x v) = F_aero + F_thrust + m g R_bn e_z        v: velocity of the centre of gravity in b
//   I dw/dt + w x I w = M_aero                                  w: (p, q, r), I with the product ixz
//   dQ/dt = 1/2 Q * (0, w)                                      Q: attitude of b in n as a unit quaternion
// Aerodynamic forces see the velocity v - v_g and the rates w - w_g relative to the air (gusts v_g, w_g);
// thrust sees u - u_g. Physics beyond the
// rigid aircraft enter through the hooks of `Dynamics`.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/flight/aircraft.h"

namespace fatmc {

/// Places in the state vector.
namespace state {
inline constexpr std::size_t quaternion = 0;  ///< w, x, y, z of body in earth axes
inline constexpr std::size_t velocity = 4;    ///< u, v, w over ground, in body axes, m/s
inline constexpr std::size_t rates = 7;       ///< p, q, r, rad/s
inline constexpr std::size_t height = 10;     ///< above the start, m
inline constexpr std::size_t propeller = 11;  ///< revolutions a second
inline constexpr std::size_t throttle = 12;   ///< behind the speed controller's lag, 0 to 1
inline constexpr std::size_t surfaces = 13;   ///< aileron, left, right ruddervator, rad
inline constexpr std::size_t surface_rates = 16;
inline constexpr std::size_t size = 20;  ///< one entry of padding, always zero: whole vector registers
}  // namespace state

template <typename T>
using State = std::array<T, state::size>;

/// Gusts: velocity of the air (m/s) and its rotation (rad/s), body axes.
template <typename T>
struct Gust {
  std::array<T, 3> velocity{};
  std::array<T, 3> rates{};
};

/// What does not change between ticks: demanded deflections and throttle.
template <typename T>
struct Demand {
  std::array<T, 3> surfaces{};  ///< aileron, left, right ruddervator, rad
  T throttle{};
};

/// An aircraft with all products of constants taken out of the loop.
struct FlightConstants {
  explicit FlightConstants(const Aircraft& aircraft);

  double density;
  double force_scale;            ///< rho S / 2
  double half_span, half_chord;  ///< b/2, c/2
  double span, chord;
  double inverse_mass;
  double ixx, iyy, izz, ixz;
  double inverse_xx, inverse_yy, inverse_zz, inverse_xz;  ///< of the inertia matrix
  LongitudinalDerivatives lift, pitch;
  double drag_zero, drag_induced;
  LateralDerivatives side, roll, yaw;
  std::array<double, 3> thrust, torque;  ///< factors of n^2, n u, u^2
  double thrust_offset, stall_torque, torque_slope, inverse_shaft_inertia, inverse_esc;
  std::array<double, 3> servo_stiffness, servo_damping, position_limit, rate_limit, acceleration_limit;
  double full_command;
};

/// Flow around the aircraft, relative to the air, at its aerodynamic reference point.
template <typename T>
struct Flow {
  T alpha, sin_beta, p_hat, q_hat, r_hat;
  T pressure_area;  ///< rho V^2 S / 2
};

/// The rigid, symmetric aircraft and nothing else: hooks of derivative() that do nothing. What there may be
/// besides: additional_dynamics.h.
struct RigidDynamics {
  static constexpr std::size_t states = state::size;
  void start(const std::array<double, 3>&) {}
  template <typename T, std::size_t N>
  T surface(const std::array<T, N>& x, std::size_t i) const {
    return x[state::surfaces + i];
  }
  template <typename T, std::size_t N>
  void shift_air(const std::array<T, N>&, T&, T&, T&) const {}
  template <typename T, std::size_t N>
  void load(const FlightConstants&, const Flow<T>&, const std::array<T, N>&, const std::array<T, 3>&,
            std::array<T, 3>&) const {}
  template <typename T, std::size_t N>
  void react(const FlightConstants&, const std::array<T, N>&, const std::array<T, 3>&,
             std::array<T, N>&) const {}
  template <std::size_t N>
  void settle(const std::array<double, N>&) {}
};

/// Third row of R_nb: the direction of down, in body axes.
template <typename T, std::size_t N>
std::array<T, 3> down_in_body(const std::array<T, N>& x) {
  const T& w = x[0];
  const T& i = x[1];
  const T& j = x[2];
  const T& k = x[3];
  return {2.0 * (i * k - w * j), 2.0 * (j * k + w * i), w * w - i * i - j * j + k * k};
}

/// Demanded deflections of normalised commands (xi_c, eta_c, zeta_c) on top of the trim deflections. Left and
/// right ruddervator carry both pitch and yaw; together they may demand more than a surface can give.
template <typename T>
std::array<T, 3> mix(const FlightConstants& k, const std::array<T, 3>& command,
                     const std::array<double, 3>& trim) {
  return {trim[0] - k.full_command * command[0], trim[1] - k.full_command * (command[1] - command[2]),
          trim[2] - k.full_command * (command[1] + command[2])};
}

namespace internal {
template <typename T>
inline T limited(const T& value, double limit) {
  const T low(-limit);
  const T high(limit);
  const T& above = value < low ? low : value;
  return above > high ? high : above;
}
}  // namespace internal

/// dx/dt, of State<T> or of a state with the additional entries that `dynamics` knows.
template <typename T, std::size_t N, typename Dynamics = RigidDynamics>
inline void derivative(const FlightConstants& k, const std::array<T, N>& x, const Demand<T>& demand,
                       const Gust<T>& gust, std::array<T, N>& dx, const Dynamics& dynamics = {}) {
  using std::atan;
  using std::sqrt;
  constexpr std::size_t v0 = state::velocity;
  constexpr std::size_t w0 = state::rates;
  const T& u = x[v0];
  const T& v = x[v0 + 1];
  const T& w = x[v0 + 2];
  const T& p = x[w0];
  const T& q = x[w0 + 1];
  const T& r = x[w0 + 2];

  // relative to the air
  T ua = u - gust.velocity[0];
  T va = v - gust.velocity[1];
  T wa = w - gust.velocity[2];
  dynamics.shift_air(x, ua, va, wa);
  const T pa = p - gust.rates[0];
  const T qa = q - gust.rates[1];
  const T ra = r - gust.rates[2];
  const T plane2 = ua * ua + wa * wa;
  const T speed = sqrt(plane2 + va * va);
  const T inverse_speed = 1.0 / speed;
  const T alpha = atan(wa / ua);
  const T sin_beta = va * inverse_speed;
  const T p_hat = pa * (k.half_span * inverse_speed);
  const T q_hat = qa * (k.half_chord * inverse_speed);
  const T r_hat = ra * (k.half_span * inverse_speed);

  const T xi = dynamics.surface(x, 0);
  const T left = dynamics.surface(x, 1);
  const T right = dynamics.surface(x, 2);
  const T eta = 0.5 * (right + left);
  const T zeta = 0.5 * (right - left);
  const auto lateral = [&](const LateralDerivatives& c) {
    return T(c.beta * sin_beta + c.p * p_hat + c.r * r_hat + c.xi * xi + c.zeta * zeta);
  };
  const T cl = k.lift.zero + k.lift.alpha * alpha + k.lift.q * q_hat + k.lift.eta * eta;
  const T cd = k.drag_zero + k.drag_induced * (cl * cl);
  const T cm = k.pitch.zero + k.pitch.alpha * alpha + k.pitch.q * q_hat + k.pitch.eta * eta;

  // forces: drag along -v_a, lift along (w, 0, -u) / sqrt(u^2 + w^2), side force along y
  const T qs = k.force_scale * (speed * speed);
  const T drag = qs * cd * inverse_speed;
  const T lift = qs * cl / sqrt(plane2);
  const T& n = x[state::propeller];
  const T thrust = (k.thrust[0] * n + k.thrust[1] * ua) * n + k.thrust[2] * (ua * ua);
  const std::array<T, 3> force = {thrust - drag * ua + lift * wa, qs * lateral(k.side) - drag * va,
                                  -(drag * wa) - lift * ua};
  std::array<T, 3> moment = {qs * k.span * lateral(k.roll), qs * k.chord * cm - k.thrust_offset * thrust,
                             qs * k.span * lateral(k.yaw)};
  dynamics.load(k, Flow<T>{alpha, sin_beta, p_hat, q_hat, r_hat, qs}, x, force, moment);

  const std::array<T, 3> down = down_in_body(x);
  dx[v0] = force[0] * k.inverse_mass + kGravity * down[0] + r * v - q * w;
  dx[v0 + 1] = force[1] * k.inverse_mass + kGravity * down[1] + p * w - r * u;
  dx[v0 + 2] = force[2] * k.inverse_mass + kGravity * down[2] + q * u - p * v;

  const T hx = k.ixx * p - k.ixz * r;
  const T hy = k.iyy * q;
  const T hz = k.izz * r - k.ixz * p;
  const T mx = moment[0] - (q * hz - r * hy);
  const T my = moment[1] - (r * hx - p * hz);
  const T mz = moment[2] - (p * hy - q * hx);
  dx[w0] = k.inverse_xx * mx + k.inverse_xz * mz;
  dx[w0 + 1] = k.inverse_yy * my;
  dx[w0 + 2] = k.inverse_xz * mx + k.inverse_zz * mz;

  dx[0] = -0.5 * (x[1] * p + x[2] * q + x[3] * r);
  dx[1] = 0.5 * (x[0] * p + x[2] * r - x[3] * q);
  dx[2] = 0.5 * (x[0] * q + x[3] * p - x[1] * r);
  dx[3] = 0.5 * (x[0] * r + x[1] * q - x[2] * p);
  dx[state::height] = -(down[0] * u + down[1] * v + down[2] * w);

  const T torque = (k.torque[0] * n + k.torque[1] * ua) * n + k.torque[2] * (ua * ua);
  const T& tau = x[state::throttle];
  dx[state::propeller] = (k.stall_torque * tau - k.torque_slope * n - torque) * k.inverse_shaft_inertia;
  dx[state::throttle] = (demand.throttle - tau) * k.inverse_esc;

  for (std::size_t i = 0; i < 3; ++i) {
    const T& position = x[state::surfaces + i];
    const T& rate = x[state::surface_rates + i];
    const T wanted = k.servo_stiffness[i] * (demand.surfaces[i] - position) - k.servo_damping[i] * rate;
    dx[state::surfaces + i] = internal::limited(rate, k.rate_limit[i]);
    dx[state::surface_rates + i] = internal::limited(wanted, k.acceleration_limit[i]);
  }
  dx[state::size - 1] = T(0.0);
  dynamics.react(k, x, force, dx);
}

/// Holds the servos inside their rate and position stops and the quaternion on the unit sphere, after a step.
/// A servo that has met its position stop stands still.
template <typename T, std::size_t N>
inline void enforce_limits(const FlightConstants& k, std::array<T, N>& x) {
  for (std::size_t i = 0; i < 3; ++i) {
    T& position = x[state::surfaces + i];
    T& rate = x[state::surface_rates + i];
    rate = internal::limited(rate, k.rate_limit[i]);
    if (position > T(k.position_limit[i])) {
      position = T(k.position_limit[i]);
      if (rate > T(0.0)) rate = T(0.0);
    } else if (position < T(-k.position_limit[i])) {
      position = T(-k.position_limit[i]);
      if (rate < T(0.0)) rate = T(0.0);
    }
  }
  // One Newton step of 1/sqrt: the norm's error after a step is far below 1e-6, so that its square vanishes.
  const T norm2 = x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3];
  const T scale = 1.5 - 0.5 * norm2;
  for (std::size_t i = 0; i < 4; ++i) x[i] = x[i] * scale;
}

/// One classical fourth-order Runge-Kutta step of h seconds (Simulink's ode4, T 3.2.4) with demands and gusts
/// held.
template <typename T, std::size_t N, typename Dynamics = RigidDynamics>
inline void rk4_step(const FlightConstants& k, const Demand<T>& demand, const Gust<T>& gust, double h,
                     std::array<T, N>& x, const Dynamics& dynamics = {}) {
  std::array<T, N> slope;
  std::array<T, N> sum;
  std::array<T, N> at;
  derivative(k, x, demand, gust, slope, dynamics);
  for (std::size_t i = 0; i < N; ++i) {
    sum[i] = slope[i];
    at[i] = x[i] + (0.5 * h) * slope[i];
  }
  derivative(k, at, demand, gust, slope, dynamics);
  for (std::size_t i = 0; i < N; ++i) {
    sum[i] = sum[i] + 2.0 * slope[i];
    at[i] = x[i] + (0.5 * h) * slope[i];
  }
  derivative(k, at, demand, gust, slope, dynamics);
  for (std::size_t i = 0; i < N; ++i) {
    sum[i] = sum[i] + 2.0 * slope[i];
    at[i] = x[i] + h * slope[i];
  }
  derivative(k, at, demand, gust, slope, dynamics);
  for (std::size_t i = 0; i < N; ++i) x[i] = x[i] + (h / 6.0) * (sum[i] + slope[i]);
  enforce_limits(k, x);
}

/// Quaternion of bank and pitch at heading zero.
template <typename T>
std::array<T, 4> quaternion_of(const T& phi, const T& theta) {
  using std::cos;
  using std::sin;
  const T cf = cos(0.5 * phi);
  const T sf = sin(0.5 * phi);
  const T ct = cos(0.5 * theta);
  const T st = sin(0.5 * theta);
  return {cf * ct, sf * ct, cf * st, -(sf * st)};
}

/// Bank and pitch.
template <typename T, std::size_t N>
std::array<T, 2> euler_of(const std::array<T, N>& x) {
  using std::asin;
  using std::atan2;
  const std::array<T, 3> down = down_in_body(x);
  return {atan2(down[1], down[2]), asin(-down[0])};
}

}  // namespace fatmc
