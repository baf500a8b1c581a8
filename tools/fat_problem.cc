#include "tools/fat_problem.h"

#include <cmath>

#include "campaigns/models/fat_published.h"
#include "core/flight/linear_model.h"

namespace fatmc::fit {
namespace {

using Complex = std::complex<double>;
namespace published = fat_published;

/// The value nearest to the wanted one; far away when there is none.
Complex nearest(const std::vector<Complex>& values, Complex wanted) {
  Complex best(1e3, 1e3);
  for (const Complex& value : values) {
    if (std::abs(value - wanted) < std::abs(best - wanted)) best = value;
  }
  return best;
}

/// What is known, and the plausible rest that stays fixed.
Aircraft known() {
  Aircraft a;
  a.name = "FAT";
  a.mass_kg = 23.0;
  a.span_m = 5.0;
  a.wing_area_m2 = 1.1;
  a.chord_m = 0.22;
  a.altitude_m = 610.0;
  a.speed_m_s = 24.0;
  a.full_command_rad = 0.6981;
  a.aileron = a.ruddervator = Actuator{40.0, 0.9, 0.6981, 1.0472, 25000.0};
  // The ESC's pole is its own: nothing acts back on it.
  a.propulsion.esc_time_constant_s = -1.0 / published::continuous(published::kTableA5[7]).real();
  a.propulsion.diameter_m = 0.5;
  a.propulsion.thrust = {0.11, -0.06, -0.09};
  a.propulsion.torque = {0.0065, 0.003, -0.008};
  a.propulsion.torque_slope_n_m_s = 0.02;
  const double degree = kPi / 180.0;
  a.validity = {-12.0 * degree, 14.0 * degree, 25.0 * degree, 75.0 * degree, 45.0 * degree, 12.0, 45.0};
  return a;
}

}  // namespace

Problem fat_problem() {
  Problem out;
  out.start = known();
  const auto add = [&](std::string name, auto of, double prior, double spread) {
    out.parameters.push_back({std::move(name), of, prior, spread});
  };
  add(
      "Ixx", [](Aircraft& a) -> double& { return a.ixx_kg_m2; }, 8.9, 1.5);
  add(
      "Iyy", [](Aircraft& a) -> double& { return a.iyy_kg_m2; }, 7.6, 1.5);
  add(
      "Izz", [](Aircraft& a) -> double& { return a.izz_kg_m2; }, 15.5, 2.0);
  add(
      "Ixz", [](Aircraft& a) -> double& { return a.ixz_kg_m2; }, 0.2, 0.3);
  add(
      "CL0", [](Aircraft& a) -> double& { return a.lift.zero; }, 0.4, 0.2);
  add(
      "CLa", [](Aircraft& a) -> double& { return a.lift.alpha; }, 4.9, 0.4);
  add(
      "CLq", [](Aircraft& a) -> double& { return a.lift.q; }, 4.0, 2.0);
  add(
      "CLeta", [](Aircraft& a) -> double& { return a.lift.eta; }, 0.2, 0.03);
  add(
      "CD0", [](Aircraft& a) -> double& { return a.drag_zero; }, 0.028, 0.008);
  add(
      "k", [](Aircraft& a) -> double& { return a.drag_induced; }, 0.0175, 0.004);
  add(
      "Cm0", [](Aircraft& a) -> double& { return a.pitch.zero; }, 0.03, 0.1);
  add(
      "Cma", [](Aircraft& a) -> double& { return a.pitch.alpha; }, -0.66, 0.2);
  add(
      "Cmq", [](Aircraft& a) -> double& { return a.pitch.q; }, -12.0, 4.0);
  add(
      "Cmeta", [](Aircraft& a) -> double& { return a.pitch.eta; }, -1.4, 0.1);
  add(
      "CYb", [](Aircraft& a) -> double& { return a.side.beta; }, -0.35, 0.1);
  add(
      "CYp", [](Aircraft& a) -> double& { return a.side.p; }, 0.0, 0.05);
  add(
      "CYr", [](Aircraft& a) -> double& { return a.side.r; }, 0.12, 0.05);
  add(
      "CYzeta", [](Aircraft& a) -> double& { return a.side.zeta; }, 0.12, 0.04);
  add(
      "Clb", [](Aircraft& a) -> double& { return a.roll.beta; }, -0.08, 0.03);
  add(
      "Clp", [](Aircraft& a) -> double& { return a.roll.p; }, -0.66, 0.1);
  add(
      "Clr", [](Aircraft& a) -> double& { return a.roll.r; }, 0.17, 0.05);
  add(
      "Clxi", [](Aircraft& a) -> double& { return a.roll.xi; }, -0.25, 0.05);
  add(
      "Clzeta", [](Aircraft& a) -> double& { return a.roll.zeta; }, 0.004, 0.015);
  add(
      "Cnb", [](Aircraft& a) -> double& { return a.yaw.beta; }, 0.034, 0.01);
  add(
      "Cnp", [](Aircraft& a) -> double& { return a.yaw.p; }, -0.06, 0.02);
  add(
      "Cnr", [](Aircraft& a) -> double& { return a.yaw.r; }, -0.049, 0.015);
  add(
      "Cnxi", [](Aircraft& a) -> double& { return a.yaw.xi; }, 0.006, 0.004);
  add(
      "Cnzeta", [](Aircraft& a) -> double& { return a.yaw.zeta; }, -0.035, 0.008);
  add(
      "J", [](Aircraft& a) -> double& { return a.propulsion.inertia_kg_m2; }, 0.003, 0.001);
  add(
      "Qstall", [](Aircraft& a) -> double& { return a.propulsion.stall_torque_n_m; }, 5.0, 1.5);
  add(
      "zT", [](Aircraft& a) -> double& { return a.propulsion.offset_m; }, 0.05, 0.05);
  add(
      "CT1", [](Aircraft& a) -> double& { return a.propulsion.thrust[1]; }, -0.06, 0.02);

  // Poles: real and imaginary part, exactly; scaled to 1e-5 of |s|.
  std::vector<Complex> poles;
  for (const std::size_t i : {0U, 1U, 2U, 3U, 4U, 5U}) {
    const auto& entry = published::kTableA5[i];
    const Complex s = published::continuous(entry);
    poles.push_back(s);
    const double tolerance = 1e-5 * std::abs(s);
    out.targets.push_back({std::string(entry.mode) + " re", s.real(), tolerance, true});
    if (s.imag() != 0.0) out.targets.push_back({std::string(entry.mode) + " im", s.imag(), tolerance, true});
  }
  // Zeros: the r/zeta_c pair exactly; the others, three printed digits at best, as the poles allow.
  const auto& pair = published::kTableA2[4];
  const double omega = 2.0 * kPi * pair.frequency_hz;
  const Complex yaw_zero(-pair.damping * omega, omega * std::sqrt(1.0 - pair.damping * pair.damping));
  const double theta2 = -2.0 * kPi * published::kTableA1[3].frequency_hz;
  const double roll_zero = -2.0 * kPi * published::kTableA2[3].frequency_hz;
  // Sum and product of the pair: smooth where a pair meets the real axis.
  out.targets.push_back({"r/zeta sum", 2.0 * yaw_zero.real(), 1e-5 * omega, true});
  out.targets.push_back({"r/zeta product", std::norm(yaw_zero), 1e-5 * omega * omega, true});
  out.targets.push_back({"T_theta1", -published::kTheta1, 0.1});
  out.targets.push_back({"T_theta2", theta2, 0.05});
  out.targets.push_back({"r/xi", roll_zero, 0.05});
  // Conventions of the model file: body axes such that level flight has 2.5 degrees and no deflection, at 45
  // % throttle.
  out.targets.push_back({"trim alpha", 2.5 * kPi / 180.0, 1e-5, true});
  out.targets.push_back({"trim eta", 0.0, 1e-5, true});
  out.targets.push_back({"trim throttle", 0.45, 1e-3, true});
  // Ixx + Iyy - Izz = 2 times the integral of z^2 dm: small for a flat aircraft, never negative.
  out.targets.push_back({"flatness", 0.8, 0.15});

  out.model = [poles, theta2, roll_zero](const Aircraft& a) {
    const Trim trim = trim_level(a);
    const LinearModel linear = linearize(a, trim);
    const std::vector<Complex> all = linear.poles();
    const std::vector<Complex> pitch = linear.zeros(1, 1);
    std::vector<double> values;
    for (const Complex& wanted : poles) {
      const Complex s = nearest(all, wanted);
      values.push_back(s.real());
      if (wanted.imag() != 0.0) values.push_back(s.imag());
    }
    // Sorted by magnitude: the slow pair of r/zeta_c comes first, s = 0 of q/eta_c before T_theta1.
    const std::vector<Complex> yaw = linear.zeros(2, 2);
    if (yaw.size() < 2 || pitch.size() < 3)
      return Eigen::VectorXd(Eigen::VectorXd::Constant(18, std::nan("")));
    values.insert(values.end(),
                  {(yaw[0] + yaw[1]).real(), (yaw[0] * yaw[1]).real(), pitch[1].real(),
                   nearest(pitch, theta2).real(), nearest(linear.zeros(2, 0), roll_zero).real(),
                   trim.alpha_rad, trim.eta_rad, trim.throttle, a.ixx_kg_m2 + a.iyy_kg_m2 - a.izz_kg_m2});
    return Eigen::VectorXd(
        Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())));
  };
  return out;
}

}  // namespace fatmc::fit
