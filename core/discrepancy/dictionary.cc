#include "core/discrepancy/dictionary.h"

#include <algorithm>
#include <cmath>

#include "core/discrepancy/effect_knowledge.h"
#include "core/discrepancy/effect_size.h"
#include "core/discrepancy/resonance.h"

namespace fatmc {
namespace {

constexpr double kSmall = 0.25;  // of the least moderate size: nearly the derivative
constexpr int kShapePlaces =
    5;  // of the first shape; a flexible mode is found from its neighbours on the grid

/// Values of the shapes: the first on a grid, the others in the middle of their range.
std::vector<std::vector<double>> shape_grid(const EffectKind& kind, const std::vector<double>& nominal) {
  std::vector<std::vector<double>> out = {nominal};
  bool first = true;
  for (std::size_t p = 0; p < kind.parameters.size(); ++p) {
    const EffectParameter& parameter = kind.parameters[p];
    if (parameter.strength) continue;
    if (!first) {
      for (auto& values : out) values[p] = parameter.moderate(0.5, false);
      continue;
    }
    first = false;
    std::vector<std::vector<double>> next;
    for (int place = 0; place < kShapePlaces; ++place) {
      next.push_back(out.front());
      next.back()[p] = parameter.moderate(place / (kShapePlaces - 1.0), false);
    }
    out = std::move(next);
  }
  return out;
}

/// Sizes of one strength. What a limit does depends on how far it is met: more of them, and milder ones beyond.
/// Resonances are linear in their strength and need many places instead: one size of them is enough.
std::vector<double> strengths(const EffectParameter& parameter, bool one_size) {
  std::vector<double> wanted;
  if (is_limit(parameter)) {
    for (const double place : {-0.3, 0.0, 0.33, 0.67, 1.0, 1.4, 1.8}) {
      wanted.push_back(parameter.moderate(place, false));
    }
  } else {
    const double least = place_of_least(parameter);
    const double zero = to_natural(parameter, parameter.nominal);
    for (const bool mirrored : {false, true}) {
      if (mirrored && parameter.mirror == EffectParameter::Mirror::none) continue;
      const double first = parameter.moderate(least, mirrored),
                   last = parameter.moderate(1.0 - least, mirrored);
      wanted.push_back(last);
      if (one_size) continue;
      const double ratio = (to_natural(parameter, last) - zero) / (to_natural(parameter, first) - zero);
      for (const double share : {kSmall, 1.0, std::sqrt(ratio)})
        wanted.push_back(parameter.toward(first, share));
    }
  }
  std::erase_if(wanted, [&](double value) { return value < parameter.low || value > parameter.high; });
  return wanted;
}

}  // namespace

std::vector<Effect> candidate_variants(const std::vector<std::string>& excluded) {
  std::vector<Effect> out = effect_variants();
  std::erase_if(out, [&](const Effect& e) {
    if (find_knowledge(e.id) == nullptr) return true;
    return std::find(excluded.begin(), excluded.end(), e.id) != excluded.end() ||
           std::find(excluded.begin(), excluded.end(), e.name()) != excluded.end();
  });
  return out;
}

std::vector<Atom> signature_effects(const std::vector<Effect>& variants) {
  std::vector<Atom> out;
  for (std::size_t v = 0; v < variants.size(); ++v) {
    const EffectKind& kind = variants[v].kind();
    const bool resonance = !std::all_of(kind.parameters.begin(), kind.parameters.end(),
                                        [](const EffectParameter& p) { return p.strength; });
    for (const std::vector<double>& shaped : shape_grid(kind, variants[v].values)) {
      for (std::size_t p = 0; p < kind.parameters.size(); ++p) {
        if (!kind.parameters[p].strength) continue;
        for (const double value : strengths(kind.parameters[p], resonance)) {
          Atom atom{variants[v], static_cast<int>(v)};
          atom.effect.values = shaped;
          atom.effect.values[p] = value;
          out.push_back(std::move(atom));
        }
      }
    }
    if (const std::optional<Effect> broad = broad_resonance(variants[v]))
      out.push_back({*broad, static_cast<int>(v)});
  }
  return out;
}

Dictionary make_dictionary(const ModelSimulator& model, const std::vector<std::string>& excluded,
                           const Eigen::Ref<const Eigen::MatrixXd>& baseline, int threads,
                           const FlightProgress& progress) {
  Dictionary out;
  out.variants = candidate_variants(excluded);
  out.atoms = signature_effects(out.variants);
  std::vector<std::vector<Effect>> sets;
  for (const Atom& atom : out.atoms) sets.push_back({atom.effect});
  const std::vector<EffectFlights> flown = model.fly(sets, 0, Dictionary::kFlights, threads, progress);
  out.differences.setZero(baseline.rows(), static_cast<Eigen::Index>(out.atoms.size()));
  for (std::size_t a = 0; a < out.atoms.size(); ++a) {
    const std::vector<int>& completed = flown[a].completed;
    if (2 * completed.size() < static_cast<std::size_t>(Dictionary::kFlights)) continue;
    out.differences.col(static_cast<Eigen::Index>(a)) =
        (flown[a].features(Eigen::all, completed) - baseline(Eigen::all, completed)).rowwise().mean();
  }
  return out;
}

}  // namespace fatmc
