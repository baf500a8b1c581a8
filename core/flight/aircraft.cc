#include "core/flight/aircraft.h"

#include <cmath>

namespace fatmc {

double isa_density(double altitude_m) {
  // ISO 2533: T = 288.15 K - 6.5 K/km h, p = 101325 Pa (T/288.15 K)^(g/(R L)), rho = p/(R T).
  constexpr double lapse = 0.0065;
  constexpr double gas = 287.05287;
  const double temperature = 288.15 - lapse * altitude_m;
  const double pressure = 101325.0 * std::pow(temperature / 288.15, kGravity / (gas * lapse));
  return pressure / (gas * temperature);
}

Status check(const Aircraft& a) {
  const auto wrong = [](std::string key, std::string message) -> Status {
    return fail(Error{"", 0, std::move(key), std::move(message)});
  };
  if (a.ixx_kg_m2 * a.izz_kg_m2 <= a.ixz_kg_m2 * a.ixz_kg_m2) {
    return wrong("mass.ixz_kg_m2",
                 "its square is at least ixx izz, which no body has; write a smaller value");
  }
  if (a.ixx_kg_m2 + a.iyy_kg_m2 < a.izz_kg_m2 || a.ixx_kg_m2 + a.izz_kg_m2 < a.iyy_kg_m2 ||
      a.iyy_kg_m2 + a.izz_kg_m2 < a.ixx_kg_m2) {
    return wrong("mass.izz_kg_m2", "one moment of inertia exceeds the sum of the others, which no body has");
  }
  const std::array<double, 3> effective = {a.ixx_kg_m2 + a.apparent_inertia_kg_m2[0],
                                           a.iyy_kg_m2 + a.apparent_inertia_kg_m2[1],
                                           a.izz_kg_m2 + a.apparent_inertia_kg_m2[2]};
  if (!(effective[0] > 0.0 && effective[1] > 0.0 &&
        effective[0] * effective[2] > a.ixz_kg_m2 * a.ixz_kg_m2)) {
    return wrong("mass.ixx_kg_m2", "with the apparent inertia it is not positive; write a larger one");
  }
  if (a.validity.alpha_min_rad >= a.validity.alpha_max_rad) {
    return wrong("validity.alpha_min_deg", "is not below alpha_max_deg");
  }
  if (a.validity.speed_min_m_s >= a.speed_m_s || a.speed_m_s >= a.validity.speed_max_m_s) {
    return wrong("validity.speed_min_m_s", "the trim speed lies outside speed_min_m_s to speed_max_m_s");
  }
  return {};
}

}  // namespace fatmc
