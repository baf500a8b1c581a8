// Equations of AdditionalPhysics: hooks of derivative() (dynamics.h), with states of their own.
//
// A: reference point of aerodynamics and thrust, r_A from the centre of gravity:
//   v_A = v + w x r_A (inflow),   M += r_A x F
// Propeller with angular momentum h = 2 pi n J about x_b:   M += -w x (h, 0, 0) = (0, -r h, q h)
// Quadratic damping: C_l += c_l p^|p^|, ...;  cubic moments: C_m += c_m (alpha - alpha_0)^3, C_l, C_n with
//   sin(beta)^3.
// Backlash of half width d between servo x and surface s: s stands still until x drags it along,
//   s = clamp(s at the step's begin, x - d, x + d), exact while x does not turn within a step.
// Flexible mode of an axis with deflection delta (from trim), frequency w, damping z, slope k:
//   d2e/dt2 + 2 z w de/dt + w^2 e = -k w^2 delta,   gyro: rate + de/dt
//   (a positive command deflects negatively); see McLean, Automatic Flight Control Systems, on bending modes
//   in rate gyros.
// Slosh: mass m_s, sideways place y in a tank at (x, 0, z) (Dodge, NASA SP-106: equivalent mechanical model):
//   d2y/dt2 + 2 z w dy/dt + w^2 y = -a,   a: specific force along y_b at the tank
//   F_s = m_s (w^2 y + 2 z w dy/dt) acts on the body at the tank, instead of the frozen mass's -m_s a. With
//   a_0 and mu = 1/m + (tank's inverse inertia) of the body with frozen liquid:
//   dF = F_s + m_s a,   a = a_0 + mu dF   =>   a = (a_0 + mu F_s) / (1 - mu m_s)
//   What the liquid weighs down on floor and front of its tank, -m_s f with f the specific force along x_b and z_b at the tank,
//   acts at y instead of at the frozen place: M += (0, y, 0) x (-m_s f), that is
//   dL = -m_s y f_z,   dN = m_s y f_x
//   (level and at rest f_z = -g: liquid to the right rolls to the right). Left out: y in the inertia, m_s x y and m_s y^2.
#pragma once

#include "core/flight/dynamics.h"

namespace fatmc {

namespace state {
inline constexpr std::size_t slosh = size;              ///< y, dy/dt
inline constexpr std::size_t flexible = size + 2;       ///< e of roll, pitch, yaw; rad
inline constexpr std::size_t flexible_rate = size + 5;  ///< de/dt
inline constexpr std::size_t extended_size = size + 8;
}  // namespace state

class AdditionalDynamics {
 public:
  static constexpr std::size_t states = state::extended_size;

  /// Without the modes (`modes` false) it works on State<T>, too: frozen liquid, stiff structure, no play.
  /// That is what trim and linear models see.
  AdditionalDynamics(const Aircraft& aircraft, const FlightConstants& k, bool modes)
      : physics_(aircraft.additional), modes_(modes) {
    if (!modes) physics_.half_play_rad = {};
    const Slosh& s = physics_.slosh;
    slosh_mobility_ = k.inverse_mass + s.forward_m * s.forward_m * k.inverse_zz +
                      s.down_m * s.down_m * k.inverse_xx - 2.0 * s.forward_m * s.down_m * k.inverse_xz;
    for (std::size_t i = 0; i < 3; ++i) flexible_w_[i] = 2.0 * kPi * physics_.flexible[i].frequency_hz;
    slosh_w_ = 2.0 * kPi * s.frequency_hz;
  }

  /// Deflections at which linkages and structure are at rest: the begin of a flight.
  void start(const std::array<double, 3>& surfaces) { linkage_ = at_rest_ = surfaces; }
  /// Goes on from where another one stands (the aircraft has changed in flight).
  void continue_from(const AdditionalDynamics& other) {
    linkage_ = other.linkage_;
    at_rest_ = other.at_rest_;
  }

  template <typename T, std::size_t N>
  T surface(const std::array<T, N>& x, std::size_t i) const {
    const T& servo = x[state::surfaces + i];
    const double half = physics_.half_play_rad[i];
    if (half == 0.0) return physics_.surface_share[i] * servo;
    T place(linkage_[i]);
    if (place < servo - half) place = servo - half;
    if (place > servo + half) place = servo + half;
    return physics_.surface_share[i] * place;
  }

  template <typename T, std::size_t N>
  void shift_air(const std::array<T, N>& x, T& u, T& v, T& w) const {
    const auto& [rx, ry, rz] = physics_.reference_point_m;
    const T& p = x[state::rates];
    const T& q = x[state::rates + 1];
    const T& r = x[state::rates + 2];
    u = u + (q * rz - r * ry);
    v = v + (r * rx - p * rz);
    w = w + (p * ry - q * rx);
  }

  template <typename T, std::size_t N>
  void load(const FlightConstants& k, const Flow<T>& flow, const std::array<T, N>& x,
            const std::array<T, 3>& force, std::array<T, 3>& moment) const {
    const auto& [rx, ry, rz] = physics_.reference_point_m;
    moment[0] = moment[0] + (ry * force[2] - rz * force[1]);
    moment[1] = moment[1] + (rz * force[0] - rx * force[2]);
    moment[2] = moment[2] + (rx * force[1] - ry * force[0]);
    const T h = (2.0 * kPi * physics_.rotor_inertia_kg_m2) * x[state::propeller];
    moment[1] = moment[1] - x[state::rates + 2] * h;
    moment[2] = moment[2] + x[state::rates + 1] * h;
    const T alpha = flow.alpha - physics_.cubic_alpha_rad;
    const std::array<T, 3> angle = {flow.sin_beta, alpha, flow.sin_beta};
    const std::array<T, 3> rate = {flow.p_hat, flow.q_hat, flow.r_hat};
    const std::array<double, 3> length = {k.span, k.chord, k.span};
    for (std::size_t i = 0; i < 3; ++i) {
      const T damping = rate[i] < T(0.0) ? -(rate[i] * rate[i]) : rate[i] * rate[i];
      moment[i] = moment[i] + flow.pressure_area * length[i] *
                                  (physics_.quadratic_damping[i] * damping +
                                   physics_.cubic_moment[i] * (angle[i] * angle[i] * angle[i]));
    }
  }

  template <typename T, std::size_t N>
  void react(const FlightConstants& k, const std::array<T, N>& x, const std::array<T, 3>& force,
             std::array<T, N>& dx) const {
    if constexpr (N == state::extended_size) {
      if (modes_) {
        slosh(k, x, force, dx);
        bend(x, dx);
      }
    }
  }

  /// After a step: where the linkages have been dragged.
  template <std::size_t N>
  void settle(const std::array<double, N>& x) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double half = physics_.half_play_rad[i];
      linkage_[i] = std::clamp(linkage_[i], x[state::surfaces + i] - half, x[state::surfaces + i] + half);
    }
  }

 private:
  template <typename T, std::size_t N>
  void slosh(const FlightConstants& k, const std::array<T, N>& x, const std::array<T, 3>& force,
             std::array<T, N>& dx) const {
    const Slosh& s = physics_.slosh;
    if (s.mass_kg == 0.0) return;
    const T& p = x[state::rates];
    const T& q = x[state::rates + 1];
    const T& r = x[state::rates + 2];
    const T ahead = force[0] * k.inverse_mass + dx[state::rates + 1] * s.down_m + p * r * s.down_m -
                    (q * q + r * r) * s.forward_m;
    const T down = force[2] * k.inverse_mass - dx[state::rates + 1] * s.forward_m + r * p * s.forward_m -
                   (p * p + q * q) * s.down_m;
    const T roll = -s.mass_kg * x[state::slosh] * down, yaw = s.mass_kg * x[state::slosh] * ahead;
    dx[state::rates] = dx[state::rates] + k.inverse_xx * roll + k.inverse_xz * yaw;
    dx[state::rates + 2] = dx[state::rates + 2] + k.inverse_xz * roll + k.inverse_zz * yaw;
    const T frozen = force[1] * k.inverse_mass + dx[state::rates + 2] * s.forward_m -
                     dx[state::rates] * s.down_m + q * (p * s.forward_m + r * s.down_m);
    const T spring =
        (slosh_w_ * slosh_w_) * x[state::slosh] + (2.0 * s.damping * slosh_w_) * x[state::slosh + 1];
    const T specific =
        (frozen + (slosh_mobility_ * s.mass_kg) * spring) / T(1.0 - slosh_mobility_ * s.mass_kg);
    const T extra = s.mass_kg * (spring + specific);
    dx[state::velocity + 1] = dx[state::velocity + 1] + extra * k.inverse_mass;
    dx[state::rates] = dx[state::rates] + extra * (k.inverse_xz * s.forward_m - k.inverse_xx * s.down_m);
    dx[state::rates + 2] =
        dx[state::rates + 2] + extra * (k.inverse_zz * s.forward_m - k.inverse_xz * s.down_m);
    dx[state::slosh] = x[state::slosh + 1];
    dx[state::slosh + 1] = -(specific + spring);
  }

  template <typename T, std::size_t N>
  void bend(const std::array<T, N>& x, std::array<T, N>& dx) const {
    std::array<T, 3> servo;
    for (std::size_t i = 0; i < 3; ++i) servo[i] = surface(x, i) - at_rest_[i] * physics_.surface_share[i];
    const std::array<T, 3> deflection = {servo[0], 0.5 * (servo[2] + servo[1]), 0.5 * (servo[2] - servo[1])};
    for (std::size_t i = 0; i < 3; ++i) {
      const FlexibleMode& mode = physics_.flexible[i];
      const double w = flexible_w_[i];
      dx[state::flexible + i] = x[state::flexible_rate + i];
      dx[state::flexible_rate + i] = -(w * w) * (x[state::flexible + i] + mode.slope * deflection[i]) -
                                     (2.0 * mode.damping * w) * x[state::flexible_rate + i];
    }
  }

  AdditionalPhysics physics_;
  bool modes_;
  double slosh_mobility_ = 0.0, slosh_w_ = 0.0;
  std::array<double, 3> flexible_w_{};
  std::array<double, 3> linkage_{}, at_rest_{};
};

}  // namespace fatmc
