// Sizes of effects on their natural scale: logarithms of factors and frequencies, else the value.
#pragma once

#include <cmath>

#include "core/flight/effects/effect.h"
#include "core/flight/effects/effect_limit.h"

namespace fatmc {

inline bool natural_is_log(const EffectParameter& p) { return p.logarithmic && p.low > 0.0; }
inline double to_natural(const EffectParameter& p, double value) {
  return natural_is_log(p) ? std::log(value) : value;
}
inline double from_natural(const EffectParameter& p, double t) { return natural_is_log(p) ? std::exp(t) : t; }

/// Places (0 or 1) of the smallest and largest moderate strength: factors below one are large where they are low.
inline double place_of_least(const EffectParameter& p) {
  const double zero = to_natural(p, p.nominal);
  return std::abs(to_natural(p, p.moderate_low) - zero) <= std::abs(to_natural(p, p.moderate_high) - zero)
             ? 0.0
             : 1.0;
}
/// Distance of the smallest moderate strength from nominal.
inline double least_moderate(const EffectParameter& p) {
  return std::abs(to_natural(p, p.moderate(place_of_least(p), false)) - to_natural(p, p.nominal));
}

/// Largest distance of a strength from nominal, in smallest moderate sizes.
inline double relative_size(const Effect& effect) {
  const EffectKind& kind = effect.kind();
  double most = 0.0;
  for (std::size_t i = 0; i < kind.parameters.size(); ++i) {
    const EffectParameter& p = kind.parameters[i];
    if (!p.strength || !(least_moderate(p) > 0.0)) continue;
    most = std::max(most,
                    std::abs(to_natural(p, effect.values[i]) - to_natural(p, p.nominal)) / least_moderate(p));
  }
  return most;
}

}  // namespace fatmc
