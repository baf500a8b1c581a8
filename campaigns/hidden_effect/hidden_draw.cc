#include "campaigns/hidden_effect/hidden_draw.h"

#include <algorithm>
#include <cmath>

#include "core/flight/effects/effect_limit.h"

namespace fatmc::hidden_effect {
namespace {

std::size_t pick(std::size_t count, RandomStream& random) {
  return std::min(count - 1, static_cast<std::size_t>(random.uniform() * static_cast<double>(count)));
}

/// A strength between least and largest moderate size, either side of nominal, times the share; a shape in its usual range.
double value(const EffectParameter& parameter, double share, RandomStream& random) {
  const double place = random.uniform();
  const bool mirrored = random.uniform() < 0.5;
  const double moderate = parameter.moderate(place, mirrored && parameter.strength);
  if (is_limit(parameter)) return moderate;
  return std::clamp(parameter.toward(moderate, share), parameter.low, parameter.high);
}

}  // namespace

std::vector<Effect> variants_named(const std::vector<std::string>& words) {
  std::vector<Effect> out = effect_variants();
  std::erase_if(out, [&](const Effect& e) {
    return std::find(words.begin(), words.end(), e.id) == words.end() &&
           std::find(words.begin(), words.end(), e.name()) == words.end();
  });
  return out;
}

Drawn draw(const Tier& tier, RandomStream& random) {
  Drawn out;
  std::vector<Effect> left = variants_named(tier.hidden);
  for (int n = 0; n < tier.effects && !left.empty(); ++n) {
    Effect effect = left[pick(left.size(), random)];
    for (std::size_t p = 0; p < effect.values.size(); ++p) {
      effect.values[p] = value(effect.kind().parameters[p], tier.size, random);
    }
    std::erase_if(left, [&](const Effect& e) { return e.id == effect.id; });
    out.effects.push_back(std::move(effect));
  }
  for (Effect effect : variants_named(tier.uncertain)) {
    const EffectParameter& factor = effect.kind().parameters.front();
    const auto [least, most] = tier.nominal_error;
    const double error = least + (most - least) * random.uniform();
    effect.values.front() =
        std::clamp(1.0 + (random.uniform() < 0.5 ? -error : error), factor.low, factor.high);
    out.errors.push_back(std::move(effect));
  }
  if (tier.turbulence_error > 0.0) {
    for (Effect effect : variants_named({"turbulence"})) {
      effect.values.front() = std::exp(tier.turbulence_error * random.normal());
      out.errors.push_back(std::move(effect));
    }
  }
  return out;
}

}  // namespace fatmc::hidden_effect
