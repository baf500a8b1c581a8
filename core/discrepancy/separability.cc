#include "core/discrepancy/separability.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/discrepancy/candidate_scan.h"
#include "core/discrepancy/effect_knowledge.h"
#include "core/discrepancy/effect_size.h"
#include "core/flight/aircraft.h"

namespace fatmc {
namespace {

/// Whether a signature is at an end of the moderate range.
bool moderate(const Effect& effect) {
  const EffectParameter& p = effect.kind().parameters.front();
  const double t = to_natural(p, effect.values.front());
  for (const double place : {0.0, 1.0}) {
    for (const bool mirrored : {false, true}) {
      if (std::abs(t - to_natural(p, p.moderate(place, mirrored))) < 1e-9 * (1.0 + std::abs(t))) return true;
    }
  }
  return false;
}

/// `variant`: of the dictionary, or -1 where the effect is no candidate.
std::optional<Separation> separation_of(const Comparison& comparison, const Effect& effect, int variant,
                                        const Eigen::VectorXd& change) {
  Separation out{effect, change.squaredNorm(), {}, 90.0, change.squaredNorm()};
  if (!(out.energy > 0.0)) return std::nullopt;
  for (const Candidate& c :
       scan_candidates(comparison, change, Eigen::MatrixXd(comparison.size(), 0), Eigen::VectorXd())) {
    if (c.variant == variant) continue;
    const double share = std::clamp(c.gain / out.energy, 0.0, 1.0);
    out.nearest = c.effect;
    out.angle_deg = 180.0 / kPi * std::acos(std::sqrt(share));
    out.left = (1.0 - share) * out.energy;
    return out;
  }
  return std::nullopt;
}

/// Effects of one parameter that are no candidates, at both ends of their moderate range.
void add_others(const Comparison& comparison, std::vector<Separation>& out) {
  std::vector<std::vector<Effect>> sets;
  for (Effect effect : effect_variants()) {
    if (find_knowledge(effect.id) != nullptr || effect.values.size() != 1) continue;
    for (const double place : {0.0, 1.0}) {
      effect.values.front() = effect.kind().parameters.front().moderate(place, false);
      sets.push_back({effect});
    }
  }
  const Eigen::MatrixXd changes = comparison.changes(sets, ComparisonBasis::kBaseline);
  for (std::size_t s = 0; s < sets.size(); ++s) {
    const Eigen::VectorXd change = changes.col(static_cast<Eigen::Index>(s));
    if (!change.allFinite()) continue;
    if (auto one = separation_of(comparison, sets[s].front(), -1, change)) out.push_back(std::move(*one));
  }
}

}  // namespace

std::vector<Separation> separations(const Comparison& comparison) {
  std::vector<Separation> out;
  const auto& atoms = comparison.dictionary().atoms;
  std::vector<std::pair<int, double>> seen;  // candidate, distance from nominal
  for (std::size_t a = 0; a < atoms.size(); ++a) {
    const Effect& effect = atoms[a].effect;
    if (effect.values.size() != 1 || !moderate(effect)) continue;
    const double size = relative_size(effect);
    const bool mirror = std::any_of(seen.begin(), seen.end(), [&](const auto& other) {
      return other.first == atoms[a].variant && std::abs(other.second - size) < 1e-6 * size;
    });
    if (mirror) continue;
    seen.emplace_back(atoms[a].variant, size);
    auto one = separation_of(comparison, effect, atoms[a].variant,
                             comparison.atoms().col(static_cast<Eigen::Index>(a)));
    if (one) out.push_back(std::move(*one));
  }
  add_others(comparison, out);
  std::stable_sort(out.begin(), out.end(),
                   [](const Separation& a, const Separation& b) { return a.left < b.left; });
  return out;
}

}  // namespace fatmc
