#include "campaigns/base/aircraft_model.h"

#include <algorithm>

#include "campaigns/base/decoder.h"
#include "campaigns/base/effect_tables.h"

namespace fatmc {
namespace {

constexpr double kDegree = kPi / 180.0;
constexpr double kSmall = 1e-6;  // the least of what must be above zero

/// Decodes the table `key` of `top` with `read(Decoder&)`.
template <typename Read>
void section(Decoder& top, std::string_view key, Read read) {
  const Tree* table = top.table(key);
  if (table == nullptr) return;
  Decoder decoder(*table, top.name(key));
  read(decoder);
  top.take(decoder.finish());
}

std::array<double, 3> three(const std::vector<double>& values, double unit = 1.0) {
  return {values[0] * unit, values[1] * unit, values[2] * unit};
}

LongitudinalDerivatives longitudinal(Decoder& in, RealRange range) {
  LongitudinalDerivatives out;
  out.zero = in.real("zero", range);
  out.alpha = in.real("alpha", range);
  out.q = in.real("q", {.low = -500.0, .high = 500.0});
  out.eta = in.real("eta", range);
  return out;
}

LateralDerivatives lateral(Decoder& in) {
  constexpr RealRange range{.low = -10.0, .high = 10.0};
  LateralDerivatives out;
  out.beta = in.real("beta", range);
  out.p = in.real("p", range);
  out.r = in.real("r", range);
  out.xi = in.real("xi", range);
  out.zeta = in.real("zeta", range);
  return out;
}

Propulsion propulsion(Decoder& in) {
  Propulsion out;
  out.esc_time_constant_s = in.real("esc_time_constant_s", {.low = 1e-3, .high = 10.0});
  out.inertia_kg_m2 = in.real("inertia_kg_m2", {.low = kSmall, .high = 1e3});
  out.diameter_m = in.real("diameter_m", {.low = 0.01, .high = 10.0});
  out.offset_m = in.real("offset_m", {.low = -10.0, .high = 10.0});
  out.thrust = three(in.reals("thrust", 3, {.low = -5.0, .high = 5.0}));
  out.torque = three(in.reals("torque", 3, {.low = -5.0, .high = 5.0}));
  out.stall_torque_n_m = in.real("stall_torque_n_m", {.low = kSmall, .high = 1e5});
  out.torque_slope_n_m_s = in.real("torque_slope_n_m_s", {.low = 0.0, .high = 1e4});
  return out;
}

Actuator actuator(Decoder& in) {
  Actuator out;
  out.frequency_rad_s = in.real("frequency_rad_s", {.low = 1.0, .high = 1000.0});
  out.damping = in.real("damping", {.low = 0.0, .high = 10.0});
  out.position_limit_rad = in.real("position_limit_rad", {.low = kSmall, .high = kPi / 2.0});
  out.rate_limit_rad_s = in.real("rate_limit_rad_s", {.low = kSmall, .high = 1e3});
  out.acceleration_limit_rad_s2 = in.real("acceleration_limit_rad_s2", {.low = kSmall, .high = 1e8});
  return out;
}

Validity validity(Decoder& in) {
  Validity out;
  out.alpha_min_rad = kDegree * in.real("alpha_min_deg", {.low = -80.0, .high = 80.0});
  out.alpha_max_rad = kDegree * in.real("alpha_max_deg", {.low = -80.0, .high = 80.0});
  out.beta_max_rad = kDegree * in.real("beta_max_deg", {.low = 0.1, .high = 80.0});
  out.bank_max_rad = kDegree * in.real("bank_max_deg", {.low = 0.1, .high = 180.0});
  out.pitch_max_rad = kDegree * in.real("pitch_max_deg", {.low = 0.1, .high = 89.0});
  out.speed_min_m_s = in.real("speed_min_m_s", {.low = 0.1, .high = 340.0});
  out.speed_max_m_s = in.real("speed_max_m_s", {.low = 0.1, .high = 340.0});
  return out;
}

Imu imu_grade(Decoder& in, const std::string& grade) {
  constexpr double per_hour = kDegree / 3600.0;
  Imu out;
  out.grade = grade;
  out.bias_rad_s = three(in.reals("bias_deg_h", 3, {.low = -1e6, .high = 1e6}), per_hour);
  out.scale_error = three(in.reals("scale_error_ppm", 3, {.low = -5e5, .high = 5e5}), 1e-6);
  const std::vector<double> angles = in.reals("misalignment_deg", 6, {.low = -45.0, .high = 45.0});
  for (std::size_t i = 0; i < 6; ++i) out.misalignment_rad[i] = angles[i] * kDegree;
  // deg/sqrt(h) = pi/180 rad / (60 sqrt(s))
  out.noise_rad_sqrt_s = in.real("angle_random_walk_deg_sqrt_h", {.low = 0.0, .high = 1e4}) * kDegree / 60.0;
  out.range_rad_s = in.real("range_deg_s", {.low = 1.0, .high = 1e5}) * kDegree;
  out.bits = static_cast<int>(in.integer("bits", {.low = 2, .high = 52}));
  return out;
}

}  // namespace

const Imu* AircraftModel::imu(std::string_view grade) const {
  const auto at = std::find_if(imus.begin(), imus.end(), [&](const Imu& imu) { return imu.grade == grade; });
  return at == imus.end() ? nullptr : &*at;
}

Result<ModifiedFlight> modified_flight(const AircraftModel& model, const FlightSetup& setup,
                                       std::span<const Effect> further) {
  std::vector<Effect> effects = model.effects;
  effects.insert(effects.end(), further.begin(), further.end());
  return apply(model.aircraft, setup, effects);
}

Result<Flight> prepare_flight(const AircraftModel& model, const FlightSetup& setup,
                              std::span<const Effect> further) {
  const Result<ModifiedFlight> modified = modified_flight(model, setup, further);
  if (!modified) return fail(modified.error());
  return Flight::prepare(modified->aircraft, modified->setup);
}

Result<AircraftModel> decode_aircraft_model(const Tree& tree) {
  AircraftModel model;
  Aircraft& a = model.aircraft;
  Decoder top(tree, "");
  top.choice("kind", {"aircraft"});
  a.name = top.text("name");
  section(top, "mass", [&](Decoder& in) {
    constexpr RealRange inertia{.low = kSmall, .high = 1e9};
    a.mass_kg = in.real("mass_kg", {.low = kSmall, .high = 1e6});
    a.ixx_kg_m2 = in.real("ixx_kg_m2", inertia);
    a.iyy_kg_m2 = in.real("iyy_kg_m2", inertia);
    a.izz_kg_m2 = in.real("izz_kg_m2", inertia);
    a.ixz_kg_m2 = in.real("ixz_kg_m2", {.low = -1e9, .high = 1e9});
  });
  section(top, "geometry", [&](Decoder& in) {
    a.wing_area_m2 = in.real("wing_area_m2", {.low = kSmall, .high = 1e4});
    a.span_m = in.real("span_m", {.low = kSmall, .high = 200.0});
    a.chord_m = in.real("chord_m", {.low = kSmall, .high = 50.0});
  });
  section(top, "trim", [&](Decoder& in) {
    a.speed_m_s = in.real("speed_m_s", {.low = 1.0, .high = 300.0});
    a.altitude_m = in.real("altitude_m", {.low = -500.0, .high = 11000.0});
  });
  section(top, "lift", [&](Decoder& in) { a.lift = longitudinal(in, {.low = -20.0, .high = 20.0}); });
  section(top, "drag", [&](Decoder& in) {
    a.drag_zero = in.real("zero", {.low = 0.0, .high = 2.0});
    a.drag_induced = in.real("induced", {.low = 0.0, .high = 2.0});
  });
  section(top, "pitch", [&](Decoder& in) { a.pitch = longitudinal(in, {.low = -20.0, .high = 20.0}); });
  section(top, "side", [&](Decoder& in) { a.side = lateral(in); });
  section(top, "roll", [&](Decoder& in) { a.roll = lateral(in); });
  section(top, "yaw", [&](Decoder& in) { a.yaw = lateral(in); });
  section(top, "propulsion", [&](Decoder& in) { a.propulsion = propulsion(in); });
  section(top, "aileron", [&](Decoder& in) { a.aileron = actuator(in); });
  section(top, "ruddervator", [&](Decoder& in) { a.ruddervator = actuator(in); });
  section(top, "command", [&](Decoder& in) {
    a.full_command_rad = in.real("full_deflection_rad", {.low = kSmall, .high = kPi / 2.0});
  });
  section(top, "validity", [&](Decoder& in) { a.validity = validity(in); });
  section(top, "imu", [&](Decoder& grades) {
    const Tree* table = tree.find("imu");
    for (const auto& [grade, entry] : table->table()->entries) {
      section(grades, grade, [&](Decoder& in) { model.imus.push_back(imu_grade(in, grade)); });
    }
  });
  const std::vector<const Tree*> effects = top.tables("effect", false);
  if (const Status status = top.finish(); !status) return fail(status.error());
  Result<std::vector<Effect>> decoded = decode_effects(effects);
  if (!decoded) return fail(decoded.error());
  model.effects = std::move(*decoded);
  if (Status status = check(a); !status) {
    Error error = status.error();
    error.file = tree.file;
    // The key is "table.entry": its line where the file has it.
    const std::size_t dot = error.key.find('.');
    const Tree* table = tree.find(error.key.substr(0, dot));
    const Tree* entry = table != nullptr ? table->find(error.key.substr(dot + 1)) : nullptr;
    if (entry != nullptr) error.line = entry->line;
    return fail(error);
  }
  return model;
}

}  // namespace fatmc
