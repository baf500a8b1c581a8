#include "core/flight/effects/listing.h"

#include <algorithm>
#include <vector>

#include "core/base/text.h"
#include "core/flight/effects/effect.h"

namespace fatmc {
namespace {

std::string padded(std::string text, std::size_t width) {
  text.resize(std::max(text.size() + 1, width), ' ');
  return text;
}

std::string choices_of(const EffectKind& kind) {
  std::string out;
  for (const EffectChoice& choice : kind.choices) {
    std::vector<std::string> values(choice.values.begin(), choice.values.end());
    out += (out.empty() ? "" : ", ") + std::string(choice.name) + "=" + join(values, "|");
  }
  return out;
}

std::string unit_of(const EffectParameter& p) { return p.unit == "1" ? "" : " " + std::string(p.unit); }

std::string range_of(const EffectParameter& p) {
  return shortest(p.low) + " to " + shortest(p.high) + unit_of(p);
}

}  // namespace

std::string effect_listing() {
  std::string out =
      "ID:name=value,...   choices must be given; a strength at its nominal value is no effect; shapes may "
      "be left "
      "out.\nAll but those marked * may begin in flight: onset_s=T[,duration_s=D].\n\n";
  for (const EffectKind& kind : effect_library()) {
    out += padded(std::string(kind.id) + (kind.changes_in_flight ? "" : "*"), 24) + std::string(kind.title);
    const std::string choices = choices_of(kind);
    out += (choices.empty() ? "" : "; " + choices) + "\n";
    for (const EffectParameter& p : kind.parameters) {
      out += "    " + padded(std::string(p.name), 20) + padded(range_of(p), 26) +
             padded((p.strength ? "nominal " : "shape, else ") + shortest(p.nominal), 20) +
             std::string(p.meaning) + "\n";
    }
  }
  return out;
}

std::string effect_table_markdown() {
  std::string out =
      "| effect | choices | parameter (nominal; range; moderate) | physics |\n|---|---|---|---|\n";
  for (const EffectKind& kind : effect_library()) {
    std::vector<std::string> parameters;
    for (const EffectParameter& p : kind.parameters) {
      parameters.push_back("`" + std::string(p.name) + "` (" + shortest(p.nominal) + "; " + range_of(p) +
                           "; " + shortest(p.moderate_low) + " to " + shortest(p.moderate_high) + ")");
    }
    std::string choices;
    for (const EffectChoice& choice : kind.choices) {
      std::vector<std::string> values(choice.values.begin(), choice.values.end());
      choices += (choices.empty() ? "" : "; ") + std::string(choice.name) + ": " + join(values);
    }
    out += "| `" + std::string(kind.id) + "`" + (kind.changes_in_flight ? "" : "*") + " | " + choices +
           " | " + join(parameters, "; ") + " | ";
    for (const char c : kind.physics) out += c == '|' ? std::string("\\|") : std::string(1, c);
    out += " |\n";
  }
  return out;
}

}  // namespace fatmc
