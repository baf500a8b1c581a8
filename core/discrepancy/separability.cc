#include "core/discrepancy/separability.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/discrepancy/candidate_scan.h"
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

std::optional<Separation> separation_of(const Comparison& comparison, std::size_t atom) {
  const Atom& own = comparison.dictionary().atoms[atom];
  const Eigen::VectorXd change = comparison.atoms().col(static_cast<Eigen::Index>(atom));
  Separation out{own.effect, change.squaredNorm(), {}, 90.0, change.squaredNorm()};
  if (!(out.energy > 0.0)) return std::nullopt;
  for (const Candidate& c :
       scan_candidates(comparison, change, Eigen::MatrixXd(comparison.size(), 0), Eigen::VectorXd())) {
    if (c.variant == own.variant) continue;
    const double share = std::clamp(c.gain / out.energy, 0.0, 1.0);
    out.nearest = c.effect;
    out.angle_deg = 180.0 / kPi * std::acos(std::sqrt(share));
    out.left = (1.0 - share) * out.energy;
    return out;
  }
  return std::nullopt;
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
    if (auto one = separation_of(comparison, a)) out.push_back(std::move(*one));
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const Separation& a, const Separation& b) { return a.left < b.left; });
  return out;
}

}  // namespace fatmc
