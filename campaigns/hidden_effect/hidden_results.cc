#include "campaigns/hidden_effect/hidden_results.h"

#include <algorithm>
#include <optional>

#include "campaigns/hidden_effect/row_metrics.h"
#include "core/flight/effects/effect.h"

namespace fatmc::hidden_effect {
namespace {

const std::vector<Effect>& variants() {
  static const std::vector<Effect> all = effect_variants();
  return all;
}

std::optional<double> metric(const TrialRow& row, std::string_view name) {
  for (const auto& [key, value] : row.metrics) {
    if (key == name) return value;
  }
  return std::nullopt;
}

double number(const TrialRow& row, std::string_view name, double fallback = 0.0) {
  return metric(row, name).value_or(fallback);
}

int integer(const TrialRow& row, std::string_view name) { return static_cast<int>(number(row, name, -1.0)); }

enum Answer { none, named, effect_class, unknown, failed };

/// What the confusion matrix has for a trial with one hidden effect.
int named_instead(const TrialRow& row, Answer answer, bool right, int hidden) {
  switch (answer) {
    case none:
      return CellResults::kNothing;
    case unknown:
      return CellResults::kUnknown;
    case failed:
      return CellResults::kFailed;
    case effect_class:
      return right ? hidden : CellResults::kClass;
    case named:
      break;
  }
  return right ? hidden : integer(row, kNamed[0]);
}

void read_hidden(const TrialRow& row, Answer answer, std::size_t i, CellResults& out) {
  HiddenOne one;
  one.effect = integer(row, kHidden[i]);
  one.size = number(row, kSize[i]);
  one.detected = answer != none && answer != failed;
  one.right = number(row, kRight[i]) > 0.5;
  if (const auto before = metric(row, kGapBefore))
    one.discrepancy = std::max(0.0, *before - number(row, kGapFloor));
  CellResults::OneEffect& effect = out.by_effect[one.effect];
  effect.detected.add(one.detected);
  effect.right.add(one.right);
  effect.unknown.add(answer == unknown);
  if (const auto error = metric(row, kParameterError[i])) {
    effect.error.push_back(*error);
    out.parameter_error.push_back(*error);
  }
  if (const auto covered = metric(row, kCovered[i])) {
    effect.covered.add(*covered > 0.5);
    out.covered.add(*covered > 0.5);
  }
  out.hidden.push_back(one);
}

void read_row(const TrialRow& row, CellResults& out) {
  const bool ok = row.outcome == "ok";
  out.failed.add(!ok);
  const Answer answer = ok ? static_cast<Answer>(integer(row, kVerdict)) : failed;
  const bool detected = answer != none && answer != failed;
  out.detected.add(detected);
  const int hidden = integer(row, kHidden[0]);
  const bool has_two = integer(row, kHidden[1]) >= 0;
  if (hidden < 0) return;
  read_hidden(row, answer, 0, out);
  if (has_two) read_hidden(row, answer, 1, out);
  const bool first = number(row, kRight[0]) > 0.5, second = has_two && number(row, kRight[1]) > 0.5;
  const bool any = first || second;
  out.right.add(first);
  if (detected) out.right_if_detected.add(first);
  out.any.add(any);
  out.both.add(first && second);
  const bool absorbable = named_by(out.tier.absorbable, variants()[static_cast<std::size_t>(hidden)]);
  (absorbable ? out.unknown_absorbable : out.unknown).add(answer == unknown);
  out.wrong.add(answer == named && !any);
  out.spurious.add(any && number(row, kSpurious) > 0.0);
  if (answer == named || answer == effect_class) {
    out.class_holds.add(number(row, kClassHolds) > 0.5);
    out.class_size.push_back(number(row, kClassSize, 1.0));
  }
  if (const auto left = metric(row, kGapLeft)) {
    out.gap_left.push_back(*left);
    out.gap_before.push_back(number(row, kGapBefore));
    out.gap_after.push_back(number(row, kGapAfter));
    out.gap_floor.push_back(number(row, kGapFloor));
  }
  if (!has_two) ++out.confusion[{hidden, named_instead(row, answer, first, hidden)}];
}

}  // namespace

Result<std::vector<CellResults>> read_results(const CampaignSpec& spec, const RowSource& rows) {
  std::vector<CellResults> out;
  for (std::uint32_t c = 0; c < spec.cells.size(); ++c) {
    CellResults results;
    results.name = spec.cells[c].name;
    auto tier = decode_hidden_tier(spec.cells[c].tree);
    if (!tier) return fail(tier.error());
    results.tier = std::move(*tier);
    rows(c, [&](const TrialRow& row) { read_row(row, results); });
    out.push_back(std::move(results));
  }
  return out;
}

std::string effect_name(int number) {
  switch (number) {
    case CellResults::kNothing:
      return "nothing";
    case CellResults::kClass:
      return "class";
    case CellResults::kUnknown:
      return "unknown";
    case CellResults::kFailed:
      return "no answer";
    default:
      break;
  }
  if (number < 0 || number >= static_cast<int>(variants().size())) return "?";
  return variants()[static_cast<std::size_t>(number)].name();
}

}  // namespace fatmc::hidden_effect
