// Internal to core/flight/effects: the library by where effects act.
#pragma once

#include "core/flight/effects/effect.h"

namespace fatmc::effects {

inline constexpr double kDegree = kPi / 180.0;

std::vector<EffectKind> airframe_kinds();   ///< mass, inertia, derivatives, propeller
std::vector<EffectKind> structure_kinds();  ///< modes with states of their own, nonlinear moments
std::vector<EffectKind> actuation_kinds();  ///< controller, delay, servos, linkages, surfaces
std::vector<EffectKind> sensing_kinds();    ///< gyros, air data, turbulence

inline EffectChoice axes() { return {"axis", {"roll", "pitch", "yaw"}}; }

/// A factor, 1 without effect, between its moderate value and the reciprocal.
inline EffectParameter factor(std::string_view meaning, double moderate_low, double moderate_high,
                              double low = 0.1, double high = 10.0) {
  return {.name = "factor",
          .unit = "1",
          .meaning = meaning,
          .nominal = 1.0,
          .low = low,
          .high = high,
          .moderate_low = moderate_low,
          .moderate_high = moderate_high,
          .mirror = EffectParameter::Mirror::ratio,
          .logarithmic = true};
}

/// A difference of either sign, 0 without effect.
inline EffectParameter signed_difference(std::string_view name, std::string_view unit,
                                         std::string_view meaning, double moderate_low, double moderate_high,
                                         double limit) {
  return {.name = name,
          .unit = unit,
          .meaning = meaning,
          .nominal = 0.0,
          .low = -limit,
          .high = limit,
          .moderate_low = moderate_low,
          .moderate_high = moderate_high,
          .mirror = EffectParameter::Mirror::difference};
}

/// A size, 0 without effect.
inline EffectParameter size(std::string_view name, std::string_view unit, std::string_view meaning,
                            double moderate_low, double moderate_high, double high) {
  return {.name = name,
          .unit = unit,
          .meaning = meaning,
          .nominal = 0.0,
          .low = 0.0,
          .high = high,
          .moderate_low = moderate_low,
          .moderate_high = moderate_high};
}

/// A limit, so far away at its nominal value that nothing meets it.
inline EffectParameter limit(std::string_view name, std::string_view unit, std::string_view meaning,
                             double nominal, double moderate_low, double moderate_high, double low) {
  return {.name = name,
          .unit = unit,
          .meaning = meaning,
          .nominal = nominal,
          .low = low,
          .high = nominal,
          .moderate_low = moderate_low,
          .moderate_high = moderate_high,
          .logarithmic = true};
}

/// What shapes an effect without being one: `given` when it is not told.
inline EffectParameter shape(std::string_view name, std::string_view unit, std::string_view meaning,
                             double given, double low, double high, double moderate_low,
                             double moderate_high) {
  return {.name = name,
          .unit = unit,
          .meaning = meaning,
          .nominal = given,
          .low = low,
          .high = high,
          .moderate_low = moderate_low,
          .moderate_high = moderate_high,
          .strength = false};
}

}  // namespace fatmc::effects
