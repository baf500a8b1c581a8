#include "core/flight/effects/effect.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/text.h"
#include "core/flight/effects/kinds.h"

namespace fatmc {

double EffectParameter::moderate(double place, bool mirrored) const {
  const double value = logarithmic ? moderate_low * std::pow(moderate_high / moderate_low, place)
                                   : moderate_low + place * (moderate_high - moderate_low);
  if (!mirrored || mirror == Mirror::none) return value;
  return mirror == Mirror::ratio ? nominal * nominal / value : 2.0 * nominal - value;
}

double EffectParameter::toward(double value, double share) const {
  if (!strength || share == 1.0) return value;
  if (share == 0.0) return nominal;
  return logarithmic ? nominal * std::pow(value / nominal, share) : nominal + share * (value - nominal);
}

const EffectParameter* EffectKind::parameter(std::string_view name) const {
  const auto at = std::find_if(parameters.begin(), parameters.end(),
                               [&](const EffectParameter& p) { return p.name == name; });
  return at == parameters.end() ? nullptr : &*at;
}

double EffectArguments::operator[](std::string_view parameter) const {
  const EffectParameter* const at = kind_.parameter(parameter);
  FATMC_CHECK(at != nullptr, "the effect has that parameter");
  return values_[static_cast<std::size_t>(at - kind_.parameters.data())];
}

std::string_view EffectArguments::choice(std::string_view name) const {
  for (const auto& [choice, value] : choices_) {
    if (choice == name) return value;
  }
  FATMC_CHECK(false, "the effect has that choice");
  return {};
}

std::size_t EffectArguments::axis() const {
  const std::string_view axis = choice("axis");
  return axis == "roll" ? 0 : axis == "pitch" ? 1 : 2;
}

const std::vector<EffectKind>& effect_library() {
  static const std::vector<EffectKind> all = [] {
    std::vector<EffectKind> out;
    for (const auto& group : {effects::actuation_kinds(), effects::airframe_kinds(), effects::sensing_kinds(),
                              effects::structure_kinds()}) {
      out.insert(out.end(), group.begin(), group.end());
    }
    return out;
  }();
  return all;
}

const EffectKind* find_effect(std::string_view id) {
  for (const EffectKind& kind : effect_library()) {
    if (kind.id == id) return &kind;
  }
  return nullptr;
}

const EffectKind& Effect::kind() const {
  const EffectKind* const found = find_effect(id);
  FATMC_CHECK(found != nullptr, "the id of an effect is known");
  return *found;
}

double Effect::value(std::string_view parameter) const {
  return EffectArguments(kind(), choices, values)[parameter];
}

bool Effect::nominal() const {
  const EffectKind& of = kind();
  for (std::size_t i = 0; i < of.parameters.size(); ++i) {
    if (of.parameters[i].strength && values[i] != of.parameters[i].nominal) return false;
  }
  return true;
}

std::string Effect::name() const {
  std::vector<std::string> parts;
  for (const auto& [choice, value] : choices) parts.push_back(choice + "=" + value);
  return parts.empty() ? id : id + ":" + join(parts, ",");
}

std::string Effect::text() const {
  std::string out = name();
  const EffectKind& of = kind();
  const auto add = [&](std::string_view key, double value) {
    out += out.find(':') == std::string::npos ? ":" : ",";
    out += std::string(key) + "=" + shortest(value);
  };
  for (std::size_t i = 0; i < of.parameters.size(); ++i) add(of.parameters[i].name, values[i]);
  if (onset) {
    add("onset_s", onset->start_s);
    add("duration_s", onset->duration_s);
  }
  return out;
}

std::vector<Effect> effect_variants() {
  std::vector<Effect> out;
  for (const EffectKind& kind : effect_library()) {
    Effect plain{.id = std::string(kind.id)};
    for (const EffectParameter& p : kind.parameters) plain.values.push_back(p.nominal);
    std::vector<Effect> variants = {plain};
    for (const EffectChoice& choice : kind.choices) {
      std::vector<Effect> next;
      for (const Effect& variant : variants) {
        for (const std::string_view value : choice.values) {
          next.push_back(variant);
          next.back().choices.emplace_back(choice.name, value);
        }
      }
      variants = std::move(next);
    }
    out.insert(out.end(), variants.begin(), variants.end());
  }
  return out;
}

}  // namespace fatmc
