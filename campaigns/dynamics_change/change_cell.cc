#include "campaigns/dynamics_change/change_cell.h"

#include <cmath>

#include "campaigns/base/decoder.h"
#include "core/base/text.h"

namespace fatmc::dynamics_change {
namespace {

constexpr const char* kOwnKeys[] = {"change", "strength", "either_side", "onset_s", "duration_s", "flight_s"};
constexpr const char* kOwnTables[] = {"monitor", "alarm"};  // the alarm is the summary's

Status decode_monitor(const Tree& tree, ChangeCell& out) {
  Decoder table(tree, "monitor");
  out.epoch_s = table.real("epoch_s", {.low = 0.01, .high = 1e4}, out.epoch_s);
  out.judgement.combine = table.choice("combine", {"min", "bonferroni"}, "bonferroni") == "min"
                              ? CombinationRule::min
                              : CombinationRule::bonferroni;
  out.judgement.bias = table.boolean("bias", out.judgement.bias);
  out.judgement.intergrid = table.real("intergrid", {.low = 0.0, .high = 100.0}, out.judgement.intergrid);
  return table.finish();
}

std::optional<std::array<double, 2>> pair(Decoder& table, const char* key, RealRange range) {
  if (!table.has(key)) return std::nullopt;
  const std::vector<double> values = table.reals(key, 2, range);
  if (values[0] > values[1]) table.reject(key, "is [low, high]");
  return std::array<double, 2>{values[0], values[1]};
}

/// The strengths are admissible for the first parameter of every effect.
void check_strength(Decoder& table, ChangeCell& out) {
  if (!out.strength) return;
  for (const Effect& effect : out.change) {
    const EffectParameter& p = effect.kind().parameters.front();
    for (const double value : *out.strength) {
      if (value < p.low || value > p.high) {
        table.reject("strength", shortest(value) + " lies outside " + shortest(p.low) + " to " +
                                     shortest(p.high) + " of " + effect.id);
      }
    }
    if (out.either_side && p.mirror == EffectParameter::Mirror::none) {
      table.reject("either_side", effect.id + " has one side alone");
    }
  }
}

Status decode_own(const Tree& tree, ChangeCell& out, double& flight_s) {
  // The keys of other decoders are checked by decode_flown_cell: known here are ours.
  Decoder table(tree, "cell");
  if (table.has("change")) {
    for (const std::string& text : table.texts("change")) {
      Result<Effect> effect = parse_effect(text);
      if (!effect) {
        table.reject("change", effect.error().key + ": " + effect.error().message);
      } else if (effect->onset || !effect->kind().changes_in_flight) {
        table.reject("change", effect->id + (effect->onset ? ": write the onset as onset_s of the cell"
                                                           : " cannot begin in flight"));
      } else {
        out.change.push_back(std::move(*effect));
      }
    }
  }
  out.strength = pair(table, "strength", {});
  out.either_side = table.boolean("either_side", false);
  out.duration_s = table.real("duration_s", {.low = 0.0, .high = 1e5}, 0.0);
  flight_s = table.real("flight_s", {.low = 1.0, .high = 1e5});
  const auto onset = pair(table, "onset_s", {.low = 0.0, .high = 1e5});
  if (!out.change.empty() && !onset)
    table.reject("onset_s", "is missing: when the change begins, [earliest, latest]");
  if (onset) out.onset_s = *onset;
  if (!table.error()) check_strength(table, out);
  return table.error() ? Status(fail(*table.error())) : Status{};
}

}  // namespace

Result<ChangeCell> decode_change_cell(const CampaignSpec& spec, std::uint32_t index) {
  auto flown = decode_flown_cell(spec, index, kOwnTables, kOwnKeys);
  if (!flown) return fail(flown.error());
  ChangeCell out;
  out.flown = std::move(*flown);
  out.judgement.combine = CombinationRule::bonferroni;
  if (const Tree* monitor = spec.tree.find("monitor")) {
    if (Status status = decode_monitor(*monitor, out); !status) return fail(status.error());
  }
  const Tree& tree = spec.cells.at(index).tree;
  double flight_s = 0.0;
  if (Status status = decode_own(tree, out, flight_s); !status) return fail(status.error());
  Excitation& excitation = out.flown.experiment.excitation;
  out.window_periods = excitation.periods;
  const double periods = flight_s / excitation.period_s;
  if (std::abs(periods - std::round(periods)) > 1e-9 || std::round(periods) < out.window_periods) {
    return fail(Error{
        tree.file, tree.line, "cell.flight_s",
        "is no multiple of the period of " + shortest(excitation.period_s) + " s, at least the window"});
  }
  excitation.periods = static_cast<int>(std::lround(periods));
  return out;
}

std::vector<Effect> drawn_change(const ChangeCell& cell, const TrialSeed& trial) {
  RandomStream random(trial, "effect");
  const double onset_s = cell.onset_s[0] + random.uniform() * (cell.onset_s[1] - cell.onset_s[0]);
  const double place = random.uniform();
  const bool mirrored = random.uniform() < 0.5 && cell.either_side;
  std::vector<Effect> out = cell.change;
  for (Effect& effect : out) {
    effect.onset = Onset{onset_s, cell.duration_s};
    if (!cell.strength) continue;
    EffectParameter drawn = effect.kind().parameters.front();
    drawn.moderate_low = (*cell.strength)[0];
    drawn.moderate_high = (*cell.strength)[1];
    effect.values.front() = drawn.moderate(place, mirrored);
  }
  return out;
}

}  // namespace fatmc::dynamics_change
