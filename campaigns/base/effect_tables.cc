#include "campaigns/base/effect_tables.h"

#include "core/base/text.h"

namespace fatmc {
namespace {

/// What stands behind a key of an [[effect]], as the command line would have it.
Result<std::string> text_of(const std::string& key, const Tree& value) {
  if (const auto* text = std::get_if<std::string>(&value.value)) return *text;
  if (const std::optional<double> number = real_value(value)) return shortest(*number);
  return fail(Error{value.file, value.line, "effect." + key, "is no text and no number"});
}

Result<Effect> decode_effect(const Tree& table) {
  const Tree* const id = table.find("id");
  const auto* const name = id != nullptr ? std::get_if<std::string>(&id->value) : nullptr;
  if (name == nullptr) {
    return fail(Error{table.file, table.line, "effect.id",
                      "is missing, write one that `fatmc simulate --effect list` names"});
  }
  std::vector<std::pair<std::string, std::string>> entries;
  for (const auto& [key, value] : table.table()->entries) {
    if (key == "id") continue;
    Result<std::string> text = text_of(key, value);
    if (!text) return fail(text.error());
    entries.emplace_back(key, std::move(*text));
  }
  Result<Effect> effect = effect_from(*name, entries);
  if (!effect)
    return fail(Error{table.file, table.line, "effect." + effect.error().key, effect.error().message});
  return effect;
}

}  // namespace

Result<std::vector<Effect>> decode_effects(const std::vector<const Tree*>& tables) {
  std::vector<Effect> out;
  for (const Tree* table : tables) {
    Result<Effect> effect = decode_effect(*table);
    if (!effect) return fail(effect.error());
    out.push_back(std::move(*effect));
  }
  return out;
}

std::string effect_toml(const Effect& effect) {
  const EffectKind& kind = effect.kind();
  std::string out = "[[effect]]\nid = \"" + effect.id + "\"\n";
  for (const auto& [choice, value] : effect.choices) out += choice + " = \"" + value + "\"\n";
  for (std::size_t i = 0; i < effect.values.size(); ++i) {
    out += std::string(kind.parameters[i].name) + " = " + shortest(effect.values[i]) + "\n";
  }
  if (effect.onset) {
    out += "onset_s = " + shortest(effect.onset->start_s) + "\n";
    out += "duration_s = " + shortest(effect.onset->duration_s) + "\n";
  }
  return out;
}

}  // namespace fatmc
