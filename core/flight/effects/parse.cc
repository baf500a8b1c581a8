#include <algorithm>
#include <cmath>

#include "core/base/text.h"
#include "core/flight/effects/effect.h"

namespace fatmc {
namespace {

constexpr double kLongestFlight = 1e6;  // s

template <typename Range, typename Name>
std::string names(const Range& range, Name name) {
  std::vector<std::string> out;
  for (const auto& entry : range) out.emplace_back(name(entry));
  return join(out);
}

tl::unexpected<Error> wrong(std::string_view key, std::string message) {
  return fail(Error{"", 0, std::string(key), std::move(message)});
}

/// What may be written after the id.
std::string admissible(const EffectKind& kind) {
  std::string out;
  for (const EffectChoice& c : kind.choices) {
    out += std::string(c.name) + " (" + names(c.values, [](std::string_view v) { return std::string(v); }) +
           "), ";
  }
  for (const EffectParameter& p : kind.parameters) {
    out += std::string(p.name) + " (" + shortest(p.low) + " to " + shortest(p.high) + "), ";
  }
  if (kind.changes_in_flight) out += "onset_s, duration_s, ";
  out.resize(out.size() - 2);
  return out;
}

Status in_range(const EffectKind& kind, const EffectParameter& p, double value) {
  if (value >= p.low && value <= p.high) return {};
  return wrong(kind.id, std::string(p.name) + " = " + shortest(value) + " lies outside " + shortest(p.low) +
                            " to " + shortest(p.high) + (p.unit == "1" ? "" : " " + std::string(p.unit)));
}

struct Unfinished {
  const EffectKind& kind;
  Effect effect;
  std::vector<bool> given;
  std::optional<double> start_s, duration_s;
};

Status set_value(Unfinished& out, const std::string& name, const std::string& text) {
  double value = 0.0;
  if (!parse_double(text, value)) return wrong(out.kind.id, name + " = \"" + text + "\" is no number");
  if (const EffectParameter* p = out.kind.parameter(name)) {
    const auto i = static_cast<std::size_t>(p - out.kind.parameters.data());
    if (out.given[i]) return wrong(out.kind.id, name + " is given twice");
    out.given[i] = true;
    out.effect.values[i] = value;
    return {};
  }
  std::optional<double>& time = name == "onset_s" ? out.start_s : out.duration_s;
  if (time) return wrong(out.kind.id, name + " is given twice");
  time = value;
  return {};
}

Status set_entry(Unfinished& out, const std::string& name, const std::string& text) {
  for (const EffectChoice& choice : out.kind.choices) {
    if (choice.name != name) continue;
    for (const auto& [given, value] : out.effect.choices) {
      if (given == name) return wrong(out.kind.id, name + " is given twice");
    }
    out.effect.choices.emplace_back(name, text);
    return {};
  }
  if (out.kind.parameter(name) == nullptr && name != "onset_s" && name != "duration_s") {
    return wrong(out.kind.id, "has no \"" + name + "\", write " + admissible(out.kind));
  }
  return set_value(out, name, text);
}

Status finish(Unfinished& out) {
  const auto order = [&](const std::string& name) {
    const auto& all = out.kind.choices;
    return std::find_if(all.begin(), all.end(), [&](const EffectChoice& c) { return c.name == name; }) -
           all.begin();
  };
  std::sort(out.effect.choices.begin(), out.effect.choices.end(),
            [&](const auto& a, const auto& b) { return order(a.first) < order(b.first); });
  bool strong = false;
  for (std::size_t i = 0; i < out.given.size(); ++i)
    strong |= out.given[i] && out.kind.parameters[i].strength;
  if (!strong) return wrong(out.kind.id, "needs a value, write " + admissible(out.kind));
  if (out.duration_s && !out.start_s) return wrong(out.kind.id, "duration_s needs an onset_s");
  if (out.start_s) out.effect.onset = Onset{*out.start_s, out.duration_s.value_or(0.0)};
  return check(out.effect);
}

}  // namespace

Status check(const Effect& effect) {
  const EffectKind* const kind = find_effect(effect.id);
  if (kind == nullptr) {
    return wrong("effect",
                 "there is no \"" + effect.id + "\", write one of " +
                     names(effect_library(), [](const EffectKind& k) { return std::string(k.id); }));
  }
  for (const EffectChoice& choice : kind->choices) {
    const auto at = std::find_if(effect.choices.begin(), effect.choices.end(),
                                 [&](const auto& given) { return given.first == choice.name; });
    const std::string values = names(choice.values, [](std::string_view v) { return std::string(v); });
    if (at == effect.choices.end()) {
      return wrong(kind->id, "needs " + std::string(choice.name) + ", one of " + values);
    }
    if (std::find(choice.values.begin(), choice.values.end(), at->second) == choice.values.end()) {
      return wrong(kind->id, std::string(choice.name) + " = \"" + at->second + "\" is not one of " + values);
    }
  }
  if (effect.choices.size() != kind->choices.size() || effect.values.size() != kind->parameters.size()) {
    return wrong(kind->id, "needs " + admissible(*kind));
  }
  for (std::size_t i = 0; i < effect.values.size(); ++i) {
    if (Status status = in_range(*kind, kind->parameters[i], effect.values[i]); !status) return status;
  }
  if (!effect.onset) return {};
  if (!kind->changes_in_flight) return wrong(kind->id, "cannot begin in flight: leave out onset_s");
  if (!(effect.onset->start_s >= 0.0 && effect.onset->start_s <= kLongestFlight)) {
    return wrong(kind->id, "onset_s lies outside 0 to 1e6 s");
  }
  if (!(effect.onset->duration_s >= 0.0 && effect.onset->duration_s <= kLongestFlight)) {
    return wrong(kind->id, "duration_s lies outside 0 to 1e6 s");
  }
  return {};
}

Result<Effect> effect_from(std::string_view id,
                           const std::vector<std::pair<std::string, std::string>>& names_and_values) {
  Effect effect{.id = std::string(id)};
  const EffectKind* const kind = find_effect(id);
  if (kind == nullptr) return fail(check(effect).error());
  for (const EffectParameter& p : kind->parameters) effect.values.push_back(p.nominal);
  Unfinished out{*kind, std::move(effect), std::vector<bool>(kind->parameters.size()), {}, {}};
  for (const auto& [name, value] : names_and_values) {
    if (Status status = set_entry(out, name, value); !status) return fail(status.error());
  }
  if (Status status = finish(out); !status) return fail(status.error());
  return std::move(out.effect);
}

Result<Effect> parse_effect(std::string_view text) {
  const std::size_t colon = text.find(':');
  const std::string_view id = text.substr(0, colon);
  std::vector<std::pair<std::string, std::string>> entries;
  std::string_view rest = colon == std::string_view::npos ? std::string_view{} : text.substr(colon + 1);
  while (!rest.empty()) {
    const std::size_t comma = rest.find(',');
    const std::string_view entry = rest.substr(0, comma);
    rest = comma == std::string_view::npos ? std::string_view{} : rest.substr(comma + 1);
    const std::size_t equals = entry.find('=');
    if (equals == std::string_view::npos) {
      return wrong(id, "\"" + std::string(entry) + "\" is no name=value");
    }
    entries.emplace_back(entry.substr(0, equals), entry.substr(equals + 1));
  }
  return effect_from(id, entries);
}

Result<Effect> nominal_effect(std::string_view id,
                              const std::vector<std::pair<std::string, std::string>>& choices) {
  Effect effect{.id = std::string(id), .choices = choices};
  if (const EffectKind* kind = find_effect(id)) {
    for (const EffectParameter& p : kind->parameters) effect.values.push_back(p.nominal);
  }
  if (Status status = check(effect); !status) return fail(status.error());
  return effect;
}

}  // namespace fatmc
