#include "campaigns/hidden_effect/hidden_cell.h"

#include "campaigns/base/decoder.h"
#include "core/base/text.h"

namespace fatmc::hidden_effect {
namespace {

constexpr const char* kOwnKeys[] = {"hide",          "size",      "hidden",          "taken_out",
                                    "nominal_error", "uncertain", "turbulence_error"};
constexpr const char* kOwnTables[] = {"search"};

/// Words must name something that can be hidden.
void check_words(Decoder& table, std::string_view key, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if (variants_named({word}).empty()) {
      table.reject(key, "\"" + word + "\" is no effect: fatmc simulate --effect list prints ids and choices");
    }
  }
}

Status decode_search(const Tree& tree, HiddenCell& out) {
  Decoder table(tree, "search");
  out.null_flights = static_cast<int>(table.integer("null_flights", {.low = 200, .high = 100000}, 1000));
  if (table.has("classes")) {
    const Tree* classes = tree.find("classes");
    const Tree::Array* rows = classes->array();
    for (std::size_t i = 0; rows != nullptr && i < rows->items.size(); ++i) {
      std::vector<std::string> members;
      const Tree::Array* row = rows->items[i].array();
      for (std::size_t j = 0; row != nullptr && j < row->items.size(); ++j) {
        if (const auto* word = std::get_if<std::string>(&row->items[j].value)) members.push_back(*word);
      }
      if (members.size() < 2) table.reject("classes", "write lists of two names and more");
      check_words(table, "classes", members);
      out.classes.push_back(std::move(members));
    }
  }
  return table.finish();
}

}  // namespace

Result<HiddenCell> decode_hidden_cell(const CampaignSpec& spec, std::uint32_t index) {
  auto flown = decode_flown_cell(spec, index, kOwnTables, kOwnKeys);
  if (!flown) return fail(flown.error());
  HiddenCell out;
  out.flown = std::move(*flown);
  if (const Tree* search = spec.tree.find("search")) {
    if (Status status = decode_search(*search, out); !status) return fail(status.error());
  }
  Decoder own(spec.cells.at(index).tree, "cell");
  Tier& tier = out.tier;
  tier.effects = static_cast<int>(own.integer("hide", {.low = 0, .high = 2}, 1));
  tier.size = own.real("size", {.low = 0.0, .high = 10.0}, 1.0);
  tier.hidden = own.texts("hidden", std::vector<std::string>{});
  tier.nominal_error = own.real("nominal_error", {.low = 0.0, .high = 0.5}, 0.0);
  tier.uncertain = own.texts("uncertain", std::vector<std::string>{});
  tier.turbulence_error = own.real("turbulence_error", {.low = 0.0, .high = 1.0}, 0.0);
  out.taken_out = own.boolean("taken_out", false);
  check_words(own, "hidden", tier.hidden);
  check_words(own, "uncertain", tier.uncertain);
  if (tier.effects > 0 && tier.hidden.empty()) own.reject("hidden", "is empty: name what may be hidden");
  if (own.error()) return fail(*own.error());
  const Tree* model = spec.tree.find("model");
  const Tree* experiment = spec.tree.find("experiment");
  out.search_key = canonical_text(*model) + canonical_text(*experiment) + std::to_string(spec.seed) + " " +
                   std::to_string(out.null_flights) + " " + shortest(tier.turbulence_error) + " " +
                   shortest(out.flown.experiment.flight.turbulence_m_s);
  for (const double a : out.flown.experiment.excitation.amplitude_rad_s) out.search_key += " " + shortest(a);
  return out;
}

}  // namespace fatmc::hidden_effect
