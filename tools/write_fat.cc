#include "tools/write_fat.h"

#include "core/base/text.h"

namespace fatmc::fit {
namespace {

// The spiral pole, a small difference of larger terms, then moves by about 1e-5 of itself.
constexpr int kDigits = 6;

class Writer {
 public:
  void comment(const std::string& text) { out_ += "# " + text + "\n"; }
  void section(const std::string& name) { out_ += "\n[" + name + "]\n"; }
  void line(const std::string& key, const std::string& value, const std::string& meaning = "") {
    out_ += key + " = " + value;
    if (!meaning.empty()) out_ += "  # " + meaning;
    out_ += "\n";
  }
  void real(const std::string& key, double value, const std::string& meaning = "") {
    line(key, number(value), meaning);
  }
  template <typename Values>
  void list(const std::string& key, const Values& values, const std::string& meaning = "") {
    std::vector<std::string> parts;
    for (const double value : values) parts.push_back(number(value));
    line(key, "[" + join(parts) + "]", meaning);
  }
  [[nodiscard]] const std::string& text() const { return out_; }

 private:
  static std::string number(double value) {
    const std::string text = significant(value, kDigits);
    return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
  }
  std::string out_;
};

void longitudinal(Writer& w, const std::string& symbol, const LongitudinalDerivatives& d) {
  w.real("zero", d.zero, symbol + " at alpha = 0");
  w.real("alpha", d.alpha, symbol + "_alpha, 1/rad");
  w.real("q", d.q, symbol + "_q, per q c/(2V)");
  w.real("eta", d.eta, symbol + "_eta, 1/rad of symmetric ruddervator");
}

void lateral(Writer& w, const std::string& symbol, const LateralDerivatives& d) {
  w.real("beta", d.beta, symbol + "_beta, per unit of v/V");
  w.real("p", d.p, symbol + "_p, per p b/(2V)");
  w.real("r", d.r, symbol + "_r, per r b/(2V)");
  w.real("xi", d.xi, symbol + "_xi, 1/rad of aileron");
  w.real("zeta", d.zeta, symbol + "_zeta, 1/rad of antisymmetric ruddervator");
}

void actuator(Writer& w, const Actuator& a) {
  w.real("frequency_rad_s", a.frequency_rad_s);
  w.real("damping", a.damping);
  w.real("position_limit_rad", a.position_limit_rad);
  w.real("rate_limit_rad_s", a.rate_limit_rad_s);
  w.real("acceleration_limit_rad_s2", a.acceleration_limit_rad_s2);
}

void propulsion(Writer& w, const Propulsion& p) {
  w.section("propulsion");
  w.comment(
      "Electric motor, one pusher propeller; thrust along x. Chosen: diameter, C_T at rest and its "
      "curvature, C_Q, torque slope: a 0.5 m");
  w.comment(
      "propeller's usual curves. Fitted: the shaft's inertia (pole -2.174 1/s), the slope of thrust with "
      "speed, its offset.");
  w.real("esc_time_constant_s", p.esc_time_constant_s, "pole -56.367 1/s of Table A-5");
  w.real("inertia_kg_m2", p.inertia_kg_m2, "motor and propeller about the shaft");
  w.real("diameter_m", p.diameter_m);
  w.real("offset_m", p.offset_m, "thrust line above the centre of gravity");
  w.list("thrust", p.thrust, "C_T = c0 + c1 J + c2 J^2, J = u/(n D), T = rho n^2 D^4 C_T");
  w.list("torque", p.torque, "C_Q likewise, Q = rho n^2 D^5 C_Q");
  w.real("stall_torque_n_m", p.stall_torque_n_m, "of the motor at full throttle");
  w.real("torque_slope_n_m_s", p.torque_slope_n_m_s, "loss of motor torque per revolution a second");
}

void validity(Writer& w, const Validity& v) {
  constexpr double degree = kPi / 180.0;
  w.section("validity");
  w.comment("A flight that leaves this has diverged: linear lift ends, wings level is far away. Chosen.");
  w.real("alpha_min_deg", v.alpha_min_rad / degree);
  w.real("alpha_max_deg", v.alpha_max_rad / degree);
  w.real("beta_max_deg", v.beta_max_rad / degree);
  w.real("bank_max_deg", v.bank_max_rad / degree);
  w.real("pitch_max_deg", v.pitch_max_rad / degree);
  w.real("speed_min_m_s", v.speed_min_m_s);
  w.real("speed_max_m_s", v.speed_max_m_s);
}

void imus(Writer& w) {
  w.section("imu.tactical");
  w.comment(
      "Tables A-7 and A-8. Signs of the misalignments (a small rotation about an oblique axis) are a "
      "choice.");
  w.line("bias_deg_h", "[6.0, 6.0, 6.0]");
  w.line("scale_error_ppm", "[150.0, 150.0, 150.0]");
  w.line("misalignment_deg", "[0.01, -0.01, -0.01, 0.01, 0.01, -0.01]", "M_xy, M_xz, M_yx, M_yz, M_zx, M_zy");
  w.line("angle_random_walk_deg_sqrt_h", "0.07");
  w.line("range_deg_s", "300.0");
  w.line("bits", "32", "A.3 gives 1.4e-7 deg/s; the 2.43e-9 printed in A-8 is this in rad/s");
  w.section("imu.industrial");
  w.comment(
      "Figures of the ADIS16350's class (T A.5.4 names that unit and prints no values): rounded, from the "
      "class of");
  w.comment("its data sheet, not a calibration of any unit.");
  w.line("bias_deg_h", "[54.0, 54.0, 54.0]", "0.015 deg/s");
  w.line("scale_error_ppm", "[2000.0, 2000.0, 2000.0]");
  w.line("misalignment_deg", "[0.05, -0.05, -0.05, 0.05, 0.05, -0.05]");
  w.line("angle_random_walk_deg_sqrt_h", "4.2");
  w.line("range_deg_s", "300.0");
  w.line("bits", "13", "0.073 deg/s a bit");
}

}  // namespace

std::string fat_toml(const Aircraft& a) {
  Writer w;
  w.comment(
      "The Flying Autonomous Testbed, as flown by the campaigns. Written by tools/fit_fat; do not edit, run "
      "it again:");
  w.comment("    build/release/bin/fit_fat > campaigns/models/fat.toml");
  w.comment(
      "Given (Merkl 2018, 3.2 and appendix A): mass, span, trim condition, actuators, full command, tactical "
      "IMU.");
  w.comment(
      "Fitted to the poles of Table A-5 and the zeros of Tables A-1 and A-2, since no derivative is "
      "published: moments");
  w.comment(
      "of inertia, aerodynamics, shaft inertia, stall torque, slope of thrust. Chosen: what is marked so.");
  w.comment("Equations, frames and signs: core/flight/aircraft.h.");
  w.line("kind", "\"aircraft\"");
  w.line("name", "\"" + a.name + "\"");
  w.section("mass");
  w.real("mass_kg", a.mass_kg, "given");
  w.real("ixx_kg_m2", a.ixx_kg_m2, "fitted, as the next three");
  w.real("iyy_kg_m2", a.iyy_kg_m2);
  w.real("izz_kg_m2", a.izz_kg_m2);
  w.real("ixz_kg_m2", a.ixz_kg_m2, "integral of x z dm");
  w.section("geometry");
  w.real("wing_area_m2", a.wing_area_m2, "chosen: a slender wing for span and mass");
  w.real("span_m", a.span_m, "given");
  w.real("chord_m", a.chord_m, "area over span");
  w.section("trim");
  w.real("speed_m_s", a.speed_m_s,
         "given, as the altitude; level flight, no deflection, alpha 2.5 degrees by choice of axes");
  w.real("altitude_m", a.altitude_m, "fixes the density (ISA)");
  w.section("lift");
  longitudinal(w, "C_L", a.lift);
  w.section("drag");
  w.real("zero", a.drag_zero, "C_D = zero + induced C_L^2");
  w.real("induced", a.drag_induced);
  w.section("pitch");
  longitudinal(w, "C_m", a.pitch);
  w.section("side");
  lateral(w, "C_Y", a.side);
  w.section("roll");
  lateral(w, "C_l", a.roll);
  w.section("yaw");
  lateral(w, "C_n", a.yaw);
  propulsion(w, a.propulsion);
  w.section("aileron");
  w.comment("Tables A-3 and A-4; one antisymmetric servo.");
  actuator(w, a.aileron);
  w.section("ruddervator");
  w.comment("Tables A-3 and A-4; left and right each.");
  actuator(w, a.ruddervator);
  w.section("command");
  w.real("full_deflection_rad", a.full_command_rad, "of a command of 1");
  validity(w, a.validity);
  imus(w);
  return w.text();
}

}  // namespace fatmc::fit
