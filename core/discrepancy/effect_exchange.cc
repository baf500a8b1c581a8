// The steps of a selection that go back on what was chosen: dropping, exchanging, and other pairs.
#include <algorithm>

#include "core/discrepancy/effect_selection.h"
#include "core/discrepancy/effect_size.h"
#include "core/discrepancy/pair_scan.h"

namespace fatmc {
namespace {

/// A rival of an effect in a set that is not adequate: the linear model behind its gain errs by more.
constexpr double kSwapShare = 0.05;
constexpr std::size_t kPairs = 12;

}  // namespace

Explanation EffectSelection::pruned(Explanation full) const {
  for (std::size_t e = full.nuisances; full.named() > 1 && e < full.fit.effects.size();) {
    // Far above what is required it needs no flights to know that the effect stays.
    if (alternative(full, e).own > 3.0 * required_gain(full.fit.effects[e], full.law, false)) {
      ++e;
      continue;
    }
    auto less = without(full, e);
    if (less &&
        cost(*less, full.law) - full.fit.cost < required_gain(full.fit.effects[e], less->law, false)) {
      full = std::move(*less);
      e = full.nuisances;
    } else {
      ++e;
    }
  }
  return full;
}

Explanation EffectSelection::exchanged(Explanation full) const {
  for (std::size_t e = full.nuisances; full.named() > 1 && e < full.fit.effects.size(); ++e) {
    const Alternative other = alternative(full, e);
    if (other.rival < other.own - kCloseGain - (full.adequate ? kCloseShare : kSwapShare) * other.own)
      continue;
    const auto less = without(full, e);
    if (!less) continue;
    std::vector<Explanation> rivals = extended(*less, false);
    if (!rivals.empty() && cost(rivals.front(), full.law) < full.fit.cost - 1.0)
      full = std::move(rivals.front());
  }
  return full;
}

Explanation EffectSelection::paired(Explanation two) const {
  const std::vector<CandidatePair> pairs =
      scan_pairs(comparison_, nothing_.fit.residual, options_.excluded, kPairs);
  const auto found = [&](const CandidatePair& pair) {
    return std::all_of(pair.effects.begin(), pair.effects.end(), [&](const Effect& effect) {
      return std::any_of(two.fit.effects.begin(), two.fit.effects.end(),
                         [&](const Effect& own) { return own.name() == effect.name(); });
    });
  };
  int tried = 0;
  for (const CandidatePair& pair : pairs) {
    if (pair.gain < pairs.front().gain - kCloseGain - kCloseShare * pairs.front().gain) break;
    // An adequate answer stands unless another one promises more.
    if (found(pair)) {
      if (two.adequate) break;
      continue;
    }
    if (tried++ == (two.adequate ? 1 : options_.rivals)) break;
    std::vector<Effect> start = options_.nuisances;
    start.insert(start.end(), pair.effects.begin(), pair.effects.end());
    EffectFit fit = fit_effects(comparison_, std::move(start), two.law.deviation(), {options_.fit_flights});
    const double before = two.weighted_residual().squaredNorm();
    if (!fit.usable() || fit.cost > before - 1.0) continue;
    auto other = judged(std::move(fit), false);
    const auto material = [](const Effect& effect) { return relative_size(effect) >= kMaterialSize; };
    if (other && cost(*other, two.law) < before - 1.0 &&
        std::all_of(other->fit.effects.begin() + static_cast<std::ptrdiff_t>(other->nuisances),
                    other->fit.effects.end(), material)) {
      two = std::move(*other);
    }
  }
  return two;
}

}  // namespace fatmc
