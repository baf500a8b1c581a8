#include "campaigns/hidden_effect/hidden_score.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "campaigns/hidden_effect/hidden_tier.h"
#include "campaigns/hidden_effect/row_metrics.h"
#include "core/discrepancy/effect_size.h"

namespace fatmc::hidden_effect {
namespace {

double number_of(const Effect& effect) {
  static const std::vector<Effect> all = effect_variants();
  const auto at =
      std::find_if(all.begin(), all.end(), [&](const Effect& e) { return e.name() == effect.name(); });
  return static_cast<double>(at - all.begin());
}

std::string listed(const std::vector<Effect>& effects) {
  std::string out;
  for (const Effect& e : effects) out += (out.empty() ? "" : " + ") + e.text();
  return out.empty() ? "nothing" : out;
}

bool among(const Effect& effect, const std::vector<Effect>& list, const DeclaredClasses& classes) {
  return std::any_of(list.begin(), list.end(),
                     [&](const Effect& other) { return count_as_one(effect, other, classes); });
}

/// Estimate, interval and error of the first parameter.
void write_parameter(std::size_t i, const Effect& hidden, const FoundEffect& found, TrialRow& row) {
  const EffectParameter& p = hidden.kind().parameters.front();
  const ParameterEstimate& estimate = found.parameters.front();
  const double value = hidden.values.front();
  const double truth = to_natural(p, value), error = std::abs(to_natural(p, estimate.value) - truth);
  const double size = is_limit(p) ? 1.0 : std::abs(truth - to_natural(p, p.nominal));
  row.metrics.emplace_back(kFound[i], estimate.value);
  row.metrics.emplace_back(kLow[i], estimate.low);
  row.metrics.emplace_back(kHigh[i], estimate.high);
  row.metrics.emplace_back(kParameterError[i], error / size);
  row.metrics.emplace_back(kCovered[i], estimate.low <= value && value <= estimate.high ? 1.0 : 0.0);
}

}  // namespace

bool count_as_one(const Effect& a, const Effect& b, const DeclaredClasses& classes) {
  return a.name() == b.name() || std::any_of(classes.begin(), classes.end(), [&](const auto& words) {
           return named_by(words, a) && named_by(words, b);
         });
}

void write_key(const Drawn& drawn, TrialRow& row) {
  for (std::size_t i = 0; i < std::size(kHidden); ++i) {
    row.metrics.emplace_back(kHidden[i], i < drawn.effects.size() ? number_of(drawn.effects[i]) : -1.0);
  }
  for (std::size_t i = 0; i < drawn.effects.size(); ++i) {
    row.metrics.emplace_back(kSize[i], relative_size(drawn.effects[i]));
    row.metrics.emplace_back(kTruth[i], drawn.effects[i].values.front());
  }
  row.detail = "hidden " + listed(drawn.effects);
  if (!drawn.errors.empty()) row.detail += "; model off by " + listed(drawn.errors);
}

void write_answer(const Drawn& drawn, const Diagnosis& d, const DeclaredClasses& classes, TrialRow& row) {
  const bool silent = d.verdict == Verdict::none || d.verdict == Verdict::unknown;
  const std::vector<Effect> named = silent ? std::vector<Effect>{} : d.effect_list();
  row.metrics.emplace_back(kVerdict, static_cast<double>(d.verdict));
  row.metrics.emplace_back(kScan, d.evidence.scan);
  row.metrics.emplace_back(kNamedCount, static_cast<double>(named.size()));
  for (std::size_t i = 0; i < std::size(kNamed); ++i) {
    row.metrics.emplace_back(kNamed[i], i < named.size() ? number_of(named[i]) : -1.0);
  }
  row.metrics.emplace_back(kClassSize, std::max<double>(1.0, static_cast<double>(d.members.size())));
  const bool is_class = d.verdict == Verdict::effect_class;
  for (std::size_t i = 0; i < drawn.effects.size(); ++i) {
    const Effect& hidden = drawn.effects[i];
    const bool right = is_class
                           ? std::all_of(d.members.begin(), d.members.end(),
                                         [&](const Effect& e) { return count_as_one(hidden, e, classes); })
                           : among(hidden, named, classes);
    row.metrics.emplace_back(kRight[i], right ? 1.0 : 0.0);
  }
  if (!drawn.effects.empty()) {
    const Effect& first = drawn.effects.front();
    const bool holds = among(first, named, classes) || (is_class && among(first, d.members, classes));
    row.metrics.emplace_back(kClassHolds, holds ? 1.0 : 0.0);
  }
  const auto spurious = std::count_if(named.begin(), named.end(), [&](const Effect& e) {
    return !among(e, drawn.effects, classes) && !among(e, drawn.errors, classes);
  });
  row.metrics.emplace_back(kSpurious, static_cast<double>(spurious));
  for (std::size_t i = 0; i < drawn.effects.size() && !silent; ++i) {
    for (const FoundEffect& found : d.effects) {
      if (found.effect.name() == drawn.effects[i].name()) write_parameter(i, drawn.effects[i], found, row);
    }
  }
  row.detail += "; answer " + std::string(name(d.verdict));
  if (is_class) {
    row.detail += " " + listed(d.members);
  } else if (!d.effects.empty()) {
    row.detail += (d.verdict == Verdict::unknown ? ", in part " : " ") + listed(d.effect_list());
  }
}

}  // namespace fatmc::hidden_effect
