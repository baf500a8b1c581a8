// Physics that the rigid, symmetric aircraft of aircraft.h lacks, as data. The default is none of it.
//
// Equations: additional_dynamics.h. SI units and radians; positions in body axes from the centre of gravity.
#pragma once

#include <array>

namespace fatmc {

/// A structural mode that a surface excites and the gyro of one axis feels. Its reaction on the rigid body is
/// left out.
struct FlexibleMode {
  double frequency_hz = 0.0;  ///< undamped
  double damping = 0.0;       ///< ratio; negative: flutter
  double slope = 0.0;  ///< static slope of the structure at the gyro, rad per rad of deflection; 0: no mode
  bool operator==(const FlexibleMode&) const = default;
};

/// Liquid that moves sideways in its tank, as a pendulum or a mass on a spring.
struct Slosh {
  double mass_kg = 0.0;  ///< the part that moves, included in the aircraft's mass; 0: none
  double frequency_hz = 0.0;
  double damping = 0.0;    ///< ratio
  double forward_m = 0.0;  ///< of the tank
  double down_m = 0.0;
  bool operator==(const Slosh&) const = default;
};

struct AdditionalPhysics {
  /// Point to which the aerodynamic derivatives and the thrust line refer: zero while it is the centre of
  /// gravity.
  std::array<double, 3> reference_point_m{};
  double rotor_inertia_kg_m2 = 0.0;           ///< of the propeller's gyroscopic moment; its sign: the turn's
  std::array<double, 3> quadratic_damping{};  ///< C_l, C_m, C_n per p^|p^|, q^|q^|, r^|r^|
  std::array<double, 3> cubic_moment{};   ///< C_l, C_m, C_n per sin(beta)^3, (alpha - alpha_0)^3, sin(beta)^3
  double cubic_alpha_rad = 0.0;           ///< alpha_0
  std::array<double, 3> half_play_rad{};  ///< of aileron, left, right ruddervator: half the backlash
  std::array<double, 3> surface_share{1.0, 1.0, 1.0};  ///< of the deflection that the air sees; 0: lost
  std::array<double, 3> servo_drive{1.0, 1.0, 1.0};    ///< factor on the servo's stiffness; 0: stuck
  std::array<FlexibleMode, 3> flexible;                ///< roll, pitch, yaw
  Slosh slosh;
  bool operator==(const AdditionalPhysics&) const = default;

  /// A mode with states of its own, which the linear models do not have.
  [[nodiscard]] bool has_modes() const {
    return slosh.mass_kg != 0.0 || flexible[0].slope != 0.0 || flexible[1].slope != 0.0 ||
           flexible[2].slope != 0.0;
  }
};

}  // namespace fatmc
