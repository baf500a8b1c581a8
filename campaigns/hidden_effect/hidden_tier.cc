#include "campaigns/hidden_effect/hidden_tier.h"

#include <algorithm>
#include <iterator>

#include "campaigns/base/decoder.h"

namespace fatmc::hidden_effect {
namespace {

const std::vector<std::string>& role_names() {
  static const std::vector<std::string> names = {"none", "null",    "single", "quarter",
                                                 "two",  "unknown", "guard"};
  return names;
}

/// Words must name something that can be hidden.
std::vector<std::string> effects_of(Decoder& table, std::string_view key) {
  std::vector<std::string> words = table.texts(key, std::vector<std::string>{});
  for (const std::string& word : words) {
    if (variants_named({word}).empty()) {
      table.reject(key, "\"" + word + "\" is no effect: fatmc simulate --effect list prints ids and choices");
    }
  }
  return words;
}

}  // namespace

bool named_by(const std::vector<std::string>& words, const Effect& effect) {
  return std::any_of(words.begin(), words.end(),
                     [&](const std::string& word) { return word == effect.id || word == effect.name(); });
}

Result<HiddenTier> decode_hidden_tier(const Tree& cell) {
  Decoder own(cell, "cell");
  HiddenTier out;
  Tier& draw = out.draw;
  const std::string role = own.choice("tier", role_names(), "none");
  const auto at = std::find(role_names().begin(), role_names().end(), role);
  out.role = static_cast<Role>(at - role_names().begin());
  draw.effects = static_cast<int>(own.integer("hide", {.low = 0, .high = 2}, 1));
  draw.size = own.real("size", {.low = 0.0, .high = 10.0}, 1.0);
  draw.hidden = effects_of(own, "hidden");
  draw.uncertain = effects_of(own, "uncertain");
  const std::vector<double> error =
      own.reals("nominal_error", 2, {.low = 0.0, .high = 0.5}, std::vector{0.0, 0.0});
  draw.nominal_error = {error[0], error[1]};
  if (error[1] < error[0]) own.reject("nominal_error", "write the smaller error first");
  draw.turbulence_error = own.real("turbulence_error", {.low = 0.0, .high = 1.0}, 0.0);
  out.taken_out = own.boolean("taken_out", false);
  out.absorbable = effects_of(own, "absorbable");
  out.levels = own.reals("levels", 0, {.low = 0.01, .high = 10.0}, std::vector{1.0});
  if (out.levels.empty()) own.reject("levels", "is empty: write a factor a record");
  if (draw.effects > 0 && draw.hidden.empty()) own.reject("hidden", "is empty: name what may be hidden");
  if (out.role == Role::two && draw.effects != 2) own.reject("tier", "is \"two\": write hide = 2");
  if (out.role == Role::null && draw.effects != 0) own.reject("tier", "is \"null\": write hide = 0");
  if (own.error()) return fail(*own.error());
  return out;
}

}  // namespace fatmc::hidden_effect
