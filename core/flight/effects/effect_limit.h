// Limits among the strengths of effects.
#pragma once

#include "core/flight/effects/effect.h"

namespace fatmc {

/// A limit that nothing meets when it is far away, at its nominal value: its effect does not scale with the distance from there.
inline bool is_limit(const EffectParameter& p) { return p.strength && p.logarithmic && p.nominal == p.high; }

}  // namespace fatmc
