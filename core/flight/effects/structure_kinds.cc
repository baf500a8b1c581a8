#include "core/flight/effects/kinds.h"

namespace fatmc::effects {
namespace {

void write_flexible(const EffectArguments& with, const Trim&, Aircraft& a, FlightSetup&) {
  if (with["slope"] == 0.0) return;
  a.additional.flexible[with.axis()] = {with["frequency_hz"], with["damping"], with["slope"]};
}

void write_slosh(const EffectArguments& with, const Trim&, Aircraft& a, FlightSetup&) {
  if (with["mass_kg"] == 0.0) return;
  a.additional.slosh = {with["mass_kg"], with["frequency_hz"], with["damping"], with["forward_m"],
                        with["down_m"]};
}

constexpr double kReferenceRate = 0.1;       // rad/s
constexpr double kReferenceAngle = kDegree;  // 1 degree

void write_quadratic(const EffectArguments& with, const Trim&, Aircraft& a, FlightSetup&) {
  const std::array<double, 3> linear = {a.roll.p, a.pitch.q, a.yaw.r};
  const std::array<double, 3> length = {a.span_m, a.chord_m, a.span_m};
  const std::size_t i = with.axis();
  const double reference = kReferenceRate * length[i] / (2.0 * a.speed_m_s);
  a.additional.quadratic_damping[i] += with["ratio"] * linear[i] / reference;
}

void write_cubic(const EffectArguments& with, const Trim& reference, Aircraft& a, FlightSetup&) {
  const std::array<double, 3> linear = {a.roll.beta, a.pitch.alpha, a.yaw.beta};
  const std::size_t i = with.axis();
  if (with["ratio"] == 0.0) return;
  a.additional.cubic_moment[i] += with["ratio"] * linear[i] / (kReferenceAngle * kReferenceAngle);
  a.additional.cubic_alpha_rad = reference.alpha_rad;
}

}  // namespace

std::vector<EffectKind> structure_kinds() {
  // Moderate ones damp and stiffen: one that takes away half the damping at 0.1 rad/s, or half the stability at
  // 1 degree, leaves none for larger motions.
  EffectParameter quadratic =
      signed_difference("ratio", "1", "quadratic over linear damping at 0.1 rad/s", 0.2, 0.6, 50.0);
  EffectParameter cubic =
      signed_difference("ratio", "1", "cubic over linear static moment at 1 degree", 0.2, 0.6, 50.0);
  quadratic.mirror = cubic.mirror = EffectParameter::Mirror::none;
  return {
      {.id = "flexible_mode",
       .title = "flexible mode in the gyros",
       .physics = "A structural mode e (rad, at the gyro): d2e/dt2 + 2 z w de/dt + w^2 e = -k w^2 delta with "
                  "the surface's deflection delta "
                  "from trim; the gyro adds de/dt. Its peak over the deflection is k w/(2 z). The reaction "
                  "on the rigid body is "
                  "left out. A negative damping is flutter. (McLean, Automatic Flight Control Systems, "
                  "bending modes.)",
       .choices = {axes()},
       .parameters = {signed_difference("slope", "1", "k: static slope over deflection", 0.004, 0.015, 1.0),
                      shape("frequency_hz", "Hz", "w/(2 pi)", 2.0, 0.05, 24.0, 0.8, 2.6),
                      shape("damping", "1", "z", 0.03, -0.2, 1.0, 0.02, 0.06)},
       .once = true,
       .write = write_flexible},
      {.id = "slosh",
       .title = "liquid moves in a tank",
       .physics = "A part m_s of the mass moves sideways in its tank as a mass on a spring: d2y/dt2 + 2 z w "
                  "dy/dt + w^2 y = -a_y at the "
                  "tank, and m_s (w^2 y + 2 z w dy/dt) acts on the body there. (Dodge, NASA SP-106, "
                  "equivalent mechanical model.) "
                  "Its weight acts at y: L = -m_s y f_z, N = m_s y f_x of the specific force there.",
       .parameters = {size("mass_kg", "kg", "m_s, part of the aircraft's mass", 0.8, 2.5, 1e4),
                      shape("frequency_hz", "Hz", "w/(2 pi)", 0.8, 0.05, 10.0, 0.4, 1.2),
                      shape("damping", "1", "z", 0.05, 0.001, 1.0, 0.02, 0.08),
                      shape("forward_m", "m", "of the tank from the centre of gravity", 0.3, -20.0, 20.0, 0.2,
                            0.5),
                      shape("down_m", "m", "of the tank", 0.1, -10.0, 10.0, 0.0, 0.15)},
       .once = true,
       .write = write_slosh},
      {.id = "quadratic_damping",
       .title = "quadratic damping",
       .physics = "Damping grows with the rate (separated flow, cross flow): C_l += c p^|p^|, and alike in "
                  "pitch and yaw. ratio = added over "
                  "linear damping at 0.1 rad/s and the trim speed. Nothing of it is left for small motions.",
       .choices = {axes()},
       .parameters = {quadratic},
       .write = write_quadratic},
      {.id = "cubic_moment",
       .title = "cubic moment",
       .physics = "A moment with the third power of the flow angle: C_m += c (alpha - alpha_trim)^3; roll "
                  "and yaw with sin(beta)^3. ratio = "
                  "added over linear static moment at 1 degree.",
       .choices = {axes()},
       .parameters = {cubic},
       .write = write_cubic},
  };
}

}  // namespace fatmc::effects
