// A rigid aircraft with propeller, aileron and V-tail, as data.
//
// Frames: body axes b (x forward, y right, z down; origin at the centre of gravity), earth axes n (north,
// east, down; flat, not rotating). SI units and radians.
//
// Aerodynamics (coefficients of S, c, b; angles of the air-relative velocity (u,v,w), V = |(u,v,w)|):
//   alpha = atan(w/u),  sin(beta) = v/V,  p^ = p b/(2V),  q^ = q c/(2V),  r^ = r b/(2V)
//   C_L = C_L0 + C_La alpha + C_Lq q^ + C_Leta eta       C_D = C_D0 + k C_L^2
//   C_m = C_m0 + C_ma alpha + C_mq q^ + C_meta eta
//   C_i = C_ibeta sin(beta) + C_ip p^ + C_ir r^ + C_ixi xi + C_izeta zeta     for i in {Y, l, n}
// Drag acts against the air-relative velocity, lift perpendicular to it in the plane of symmetry, the side
// force along y_b, the moments about body axes. Side-slip enters as v/V, which saves an arc sine and differs
// from beta by beta^3/6. The aircraft is symmetric left to right: no propeller torque, and gyroscopics only as
// an addition (additional_physics.h).
//
// Surfaces: xi the aileron; left and right ruddervator give eta = (right + left)/2 and zeta = (right -
// left)/2. Positive deflections give negative moments (LN 9300), so that a positive command deflects
// negatively and gives a positive rate of its axis.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/flight/additional_physics.h"

namespace fatmc {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kGravity = 9.80665;  ///< m/s^2, standard gravity

/// Density of the ISA troposphere in kg/m^3 at a geopotential height in m (below 11,000 m).
double isa_density(double altitude_m);

/// Derivatives of one lateral coefficient (side force, rolling or yawing moment).
struct LateralDerivatives {
  double beta = 0.0;  ///< per unit of v/V
  double p = 0.0;     ///< per p b/(2V)
  double r = 0.0;     ///< per r b/(2V)
  double xi = 0.0;    ///< 1/rad
  double zeta = 0.0;  ///< 1/rad
  bool operator==(const LateralDerivatives&) const = default;
};

/// Derivatives of lift or pitching moment.
struct LongitudinalDerivatives {
  double zero = 0.0;   ///< at alpha = 0
  double alpha = 0.0;  ///< 1/rad
  double q = 0.0;      ///< per q c/(2V)
  double eta = 0.0;    ///< 1/rad
  bool operator==(const LongitudinalDerivatives&) const = default;
};

/// Electric motor and propeller.
///   throttle lag (ESC):  d(tau)/dt = (tau_c - tau) / T_esc
///   propeller speed n:   2 pi J dn/dt = Q_stall tau - Q_n n - Q      (direct-current motor: torque falls
///   with n) thrust and torque:   T = rho n^2 D^4 C_T(J_a), Q = rho n^2 D^5 C_Q(J_a), J_a = u/(n D), both
///   quadratic in J_a
/// Thrust acts along x_b, `offset_m` above the centre of gravity (a positive offset pitches down).
struct Propulsion {
  double esc_time_constant_s = 0.0;
  double inertia_kg_m2 = 0.0;       ///< J of motor and propeller about the shaft
  double diameter_m = 0.0;          ///< D
  double offset_m = 0.0;            ///< of the thrust line, upwards
  std::array<double, 3> thrust{};   ///< C_T = thrust[0] + thrust[1] J_a + thrust[2] J_a^2
  std::array<double, 3> torque{};   ///< C_Q, likewise
  double stall_torque_n_m = 0.0;    ///< Q_stall at full throttle
  double torque_slope_n_m_s = 0.0;  ///< Q_n, per revolution a second
  bool operator==(const Propulsion&) const = default;
};

/// A second-order servo: d2x/dt2 = w^2 (x_c - x) - 2 d w dx/dt, limited in position, rate and acceleration.
struct Actuator {
  double frequency_rad_s = 0.0;     ///< w
  double damping = 0.0;             ///< d
  double position_limit_rad = 0.0;  ///< symmetric
  double rate_limit_rad_s = 0.0;
  double acceleration_limit_rad_s2 = 0.0;
  bool operator==(const Actuator&) const = default;
};

/// Where the model may be believed; a flight that leaves it has diverged.
struct Validity {
  double alpha_min_rad = 0.0;
  double alpha_max_rad = 0.0;
  double beta_max_rad = 0.0;   ///< of |beta|
  double bank_max_rad = 0.0;   ///< of |phi|
  double pitch_max_rad = 0.0;  ///< of |theta|
  double speed_min_m_s = 0.0;  ///< of the airspeed
  double speed_max_m_s = 0.0;
  bool operator==(const Validity&) const = default;
};

struct Aircraft {
  std::string name;
  // mass and geometry
  double mass_kg = 0.0;
  double ixx_kg_m2 = 0.0, iyy_kg_m2 = 0.0, izz_kg_m2 = 0.0, ixz_kg_m2 = 0.0;  ///< ixz = integral of x z dm
  /// Added to ixx, iyy, izz: of the air that moves with the body (apparent inertia), or what the model has wrong. The sums
  /// need not be those of a rigid body.
  std::array<double, 3> apparent_inertia_kg_m2{};
  double wing_area_m2 = 0.0;  ///< S
  double span_m = 0.0;        ///< b
  double chord_m = 0.0;       ///< c
  // flight condition
  double altitude_m = 0.0;  ///< fixes the density, which is then constant
  double speed_m_s = 0.0;   ///< of trim
  // aerodynamics
  LongitudinalDerivatives lift, pitch;
  double drag_zero = 0.0;     ///< C_D0
  double drag_induced = 0.0;  ///< k
  LateralDerivatives side, roll, yaw;
  // the rest
  Propulsion propulsion;
  Actuator aileron, ruddervator;
  double full_command_rad = 0.0;  ///< deflection of a command of 1 (each ruddervator for pitch and yaw alike)
  Validity validity;
  AdditionalPhysics additional;  ///< beyond the above; none by default
  bool operator==(const Aircraft&) const = default;
};

/// Wrong by physics, not by type or range (inertia that no body has, limits in the wrong order).
Status check(const Aircraft& aircraft);

}  // namespace fatmc
