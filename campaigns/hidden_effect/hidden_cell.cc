#include "campaigns/hidden_effect/hidden_cell.h"

#include "campaigns/base/decoder.h"
#include "core/base/text.h"

namespace fatmc::hidden_effect {
namespace {

constexpr const char* kOwnTables[] = {"search"};

Status decode_search(const Tree& tree, HiddenCell& out) {
  Decoder table(tree, "search");
  out.null_flights = static_cast<int>(table.integer("null_flights", {.low = 200, .high = 100000}, 1000));
  if (table.has("classes")) {
    const Tree::Array* rows = tree.find("classes")->array();
    if (rows == nullptr) table.reject("classes", "write a list of lists of names");
    for (std::size_t i = 0; rows != nullptr && i < rows->items.size(); ++i) {
      std::vector<std::string> members;
      const Tree::Array* row = rows->items[i].array();
      for (std::size_t j = 0; row != nullptr && j < row->items.size(); ++j) {
        const auto* word = std::get_if<std::string>(&row->items[j].value);
        if (word == nullptr || variants_named({*word}).empty()) {
          table.reject("classes",
                       "names an effect that is none: fatmc simulate --effect list prints ids and choices");
        } else {
          members.push_back(*word);
        }
      }
      if (members.size() < 2) table.reject("classes", "write lists of two names and more");
      out.classes.push_back(std::move(members));
    }
  }
  return table.finish();
}

}  // namespace

Result<HiddenCell> decode_hidden_cell(const CampaignSpec& spec, std::uint32_t index) {
  auto flown = decode_flown_cell(spec, index, kOwnTables, kTierKeys);
  if (!flown) return fail(flown.error());
  HiddenCell out;
  out.flown = std::move(*flown);
  if (const Tree* search = spec.tree.find("search")) {
    if (Status status = decode_search(*search, out); !status) return fail(status.error());
  }
  auto tier = decode_hidden_tier(spec.cells.at(index).tree);
  if (!tier) return fail(tier.error());
  out.tier = std::move(*tier);
  const Tree* model = spec.tree.find("model");
  const Tree* experiment = spec.tree.find("experiment");
  const FlightSetup& setup = out.flown.experiment.flight;
  out.search_key = canonical_text(*model) + canonical_text(*experiment) + std::to_string(spec.seed);
  for (const double v :
       {static_cast<double>(out.null_flights), out.tier.draw.turbulence_error, setup.turbulence_m_s,
        setup.step_s, setup.turn_coordinator ? 1.0 : 0.0,
        setup.plant == FlightSetup::Plant::linear ? 1.0 : 0.0, setup.gusts_from_calm ? 1.0 : 0.0}) {
    out.search_key += " " + shortest(v);
  }
  for (const int line : out.flown.experiment.excitation.lines) out.search_key += " " + std::to_string(line);
  for (const double a : out.flown.experiment.excitation.amplitude_rad_s) out.search_key += " " + shortest(a);
  return out;
}

}  // namespace fatmc::hidden_effect
