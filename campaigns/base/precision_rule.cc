#include "campaigns/base/precision_rule.h"

#include <cmath>

#include "campaigns/base/decoder.h"

namespace fatmc {
namespace {

using Kind = ConfidenceSequenceOptions::Kind;

Result<PrecisionRule> decode_rule(const Tree& tree, const char* name, bool stops) {
  Decoder table(tree, name);
  PrecisionRule rule;
  rule.metric = table.text("metric");
  if (stops) {
    rule.half_width = table.real("half_width", {.low = 0.0});
    if (rule.half_width == 0.0) table.reject("half_width", "is 0, write the half-width that is wanted");
  }
  rule.sequence.level = table.real("level", {.low = 0.5, .high = 1.0 - 1e-9}, 0.95);
  const bool bounded = table.has("bounds");
  const std::string method =
      table.choice("method", {"bernstein", "normal"}, bounded ? "bernstein" : "normal");
  rule.sequence.kind = method == "bernstein" ? Kind::bernstein : Kind::normal;
  if (rule.sequence.kind == Kind::bernstein && !bounded) {
    table.reject("method", "bernstein needs bounds, write bounds = [low, high] that no value leaves");
  }
  if (bounded) {
    const std::vector<double> bounds = table.reals("bounds", 2);
    rule.sequence.low = bounds[0];
    rule.sequence.high = bounds[1];
    if (!table.error() && !(bounds[0] < bounds[1]))
      table.reject("bounds", "are not in order, write [low, high]");
  }
  if (table.has("missing")) rule.missing = table.real("missing");
  rule.minimum = static_cast<std::uint64_t>(table.integer("minimum", {.low = 2, .high = 1'000'000'000}, 20));
  rule.sequence.tuned_for = table.real("tuned_for", {.low = 1.0, .high = 1e9}, rule.sequence.tuned_for);
  if (Status status = table.finish(); !status) return fail(status.error());
  return rule;
}

}  // namespace

std::optional<double> PrecisionRule::value(const TrialRow& row) const {
  if (metric == "failed") return row.outcome == "ok" ? 0.0 : 1.0;
  for (const auto& [name, number] : row.metrics) {
    if (name == metric && std::isfinite(number)) return number;
  }
  return missing;
}

Result<std::optional<PrecisionRule>> decode_precision(const Tree& spec) {
  for (const bool stops : {true, false}) {
    const char* name = stops ? "stop" : "watch";
    const Tree* table = spec.find(name);
    if (table == nullptr) continue;
    Result<PrecisionRule> rule = decode_rule(*table, name, stops);
    if (!rule) return fail(rule.error());
    return std::optional<PrecisionRule>(std::move(*rule));
  }
  return std::optional<PrecisionRule>();
}

}  // namespace fatmc
