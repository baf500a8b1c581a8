#include "core/discrepancy/diagnosis.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/discrepancy/effect_knowledge.h"
#include "core/discrepancy/effect_selection.h"
#include "core/discrepancy/effect_size.h"
#include "core/discrepancy/level_probe.h"
#include "core/stats/intervals.h"

namespace fatmc {
namespace {

/// Candidate with the largest gain on the discrepancy.
std::string leading_effect(const Comparison& comparison, const DiagnosisOptions& options) {
  for (const Candidate& c : scan_candidates(comparison, comparison.discrepancy(),
                                            Eigen::MatrixXd(comparison.size(), 0), Eigen::VectorXd())) {
    if (std::find(options.excluded.begin(), options.excluded.end(), c.effect.id) == options.excluded.end()) {
      return c.effect.name();
    }
  }
  return "";
}

Gap gap_of(double before, double after, double floor, double count) {
  return {before / count, after / count, floor / count};
}

/// 95 % intervals of the effects' parameters: t +- quantile times deviation of (J^T W^-2 J)^-1 J^T W^-2 r (fitted_law.h).
std::vector<FoundEffect> found_effects(const EffectSelection& selection, const Explanation& e) {
  std::vector<FoundEffect> out;
  for (const Effect& effect : e.fit.effects) out.push_back({effect, {}, 0.0});
  const std::vector<FreeParameter> free = free_parameters(e.fit.effects);
  const Eigen::MatrixXd j = e.weighted_jacobian();
  const Eigen::MatrixXd inverse = j.completeOrthogonalDecomposition().pseudoInverse();
  const FittedLaw::Spread spread = e.law.spread(inverse * e.law.deviation().cwiseInverse().asDiagonal());
  for (std::size_t i = 0; i < free.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double t = natural_value(e.fit.effects, free[i]);
    const double half = t_quantile(0.975, spread.dof[at]) * spread.deviation[at];
    FoundEffect& found = out[static_cast<std::size_t>(free[i].effect)];
    const EffectParameter& kind = found.effect.kind().parameters[static_cast<std::size_t>(free[i].parameter)];
    const auto back = [&](double x) { return from_natural(kind, std::clamp(x, free[i].low, free[i].high)); };
    found.parameters.push_back(
        {std::string(kind.name), std::string(kind.unit), back(t), back(t - half), back(t + half)});
  }
  if (out.size() == 1) {
    out.front().gain = selection.nothing().fit.cost - e.fit.cost;
  } else {
    for (std::size_t i = 0; i < out.size(); ++i) out[i].gain = selection.alternative(e, i).own;
  }
  return out;
}

/// Rivals of the last effect that explain the records as well.
std::vector<Explanation> equals_of(const Explanation& best, std::vector<Explanation> rivals) {
  std::erase_if(rivals, [&](const Explanation& rival) {
    return rival.fit.effects.size() != best.fit.effects.size() ||
           rival.fit.effects.back().name() == best.fit.effects.back().name() || !rival.adequate ||
           EffectSelection::cost(rival, best.law) > best.fit.cost + kClassGain;
  });
  return rivals;
}

/// Forward steps from the model as it is; `rivals`: explanations by one effect, where that is what the result has.
Explanation searched(const EffectSelection& selection, const DiagnosisOptions& options, bool far,
                     std::vector<Explanation>& rivals) {
  Explanation best = selection.nothing();
  rivals.clear();
  while (static_cast<int>(best.fit.effects.size()) < options.most_effects) {
    // Half of what is required: the linear ratio of a signature may fall short of the fit's gain.
    if (best.adequate && selection.largest_ratio(best) < 0.5 * selection.scan_threshold()) break;
    const bool first = best.fit.effects.empty();
    std::vector<Explanation> next = selection.extended(best, far && first);
    if (far && first) std::erase_if(next, [](const Explanation& e) { return !e.adequate; });
    if (next.empty() || !selection.accepted(best, next.front())) break;
    best = next.front();
    if (best.fit.effects.size() == 1) rivals = std::move(next);
    if (best.fit.effects.size() > 1) best = selection.exchanged(selection.pruned(std::move(best)));
  }
  return best;
}

void measure_gaps(const Comparison& comparison, const Comparison* holdout, const EffectSelection& selection,
                  const Explanation& e, Diagnosis& out) {
  const double all = static_cast<double>(comparison.size());
  const double mean = comparison.thresholds().energy_mean / all;
  if (holdout != nullptr) {
    const auto held = static_cast<double>(holdout->size());
    out.holdout_lines = false;
    out.training = gap_of(comparison.discrepancy().squaredNorm(), e.fit.cost, mean * all, all);
    double after = holdout->discrepancy().squaredNorm();
    if (!e.fit.effects.empty()) {
      const auto law = FittedLaw::of(*holdout, e.fit.effects, FittedLaw::kFlights);
      after = law ? (holdout->discrepancy() - law->change()).cwiseQuotient(law->deviation()).squaredNorm()
                  : std::numeric_limits<double>::infinity();
    }
    out.holdout =
        gap_of(holdout->discrepancy().squaredNorm(), after, holdout->thresholds().energy_mean, held);
    return;
  }
  const std::vector<int> training = comparison.training_rows(), held = comparison.held_out_rows();
  const Eigen::VectorXd residual = selection.trained_residual(e);
  const auto ratio = [&](const std::vector<int>& rows) {
    const auto n = static_cast<double>(rows.size());
    return gap_of(comparison.discrepancy()(rows).squaredNorm(), residual(rows).squaredNorm(), mean * n, n);
  };
  out.training = ratio(training);
  out.holdout = ratio(held);
}

}  // namespace

std::string_view name(Verdict verdict) {
  switch (verdict) {
    case Verdict::none:
      return "none";
    case Verdict::named:
      return "named";
    case Verdict::effect_class:
      return "class";
    case Verdict::unknown:
      return "unknown";
  }
  return "?";
}

std::vector<Effect> Diagnosis::effect_list() const {
  std::vector<Effect> out;
  for (const FoundEffect& found : effects) out.push_back(found.effect);
  return out;
}

Diagnosis diagnose(const Comparison& comparison, const Comparison* holdout, const DiagnosisOptions& options) {
  const EffectSelection selection(comparison, holdout, options);
  const Thresholds& limit = comparison.thresholds();
  Diagnosis out;
  Explanation best = selection.nothing();
  out.evidence.scan = selection.largest_ratio(best);
  out.evidence.leading = leading_effect(comparison, options);
  out.evidence.energy = best.fit.cost;
  out.evidence.local = comparison.local_score(best.fit.residual);
  const bool found = out.evidence.scan > limit.scan || out.evidence.energy > limit.energy ||
                     out.evidence.local > limit.local;
  const LevelProbe first = probe_level(comparison, best, LevelProbe::kNothing, 0.0);
  const bool detected = found || first.failed();

  std::vector<Explanation> rivals;
  if (found) {
    best = searched(selection, options, false, rivals);
    // Nothing close to the leading candidate explains it: others have their turn before the answer is "unknown".
    if (!best.adequate) {
      Explanation other = searched(selection, options, true, rivals);
      if (other.adequate || best.fit.effects.empty()) best = std::move(other);
    }
  }

  if (!best.fit.effects.empty()) out.effects = found_effects(selection, best);
  const LevelProbe level = best.fit.effects.empty() ? first
                                                    : probe_level(comparison, best, LevelProbe::kNamed,
                                                                  kResolution * selection.excess());
  if (level.failed()) out.notes.push_back(level.statement());
  out.evidence.level = level.score;
  out.evidence.level_limit = level.limit;
  // What was detected and no effect accounts for is unknown, even where energy and groups alone would not show it.
  if (best.fit.effects.empty()) {
    out.verdict = detected ? Verdict::unknown : Verdict::none;
  } else {
    out.verdict = best.adequate && !level.failed() ? Verdict::named : Verdict::unknown;
  }
  if (out.verdict == Verdict::named && best.fit.effects.size() == 1) {
    const std::vector<Explanation> equals = equals_of(best, std::move(rivals));
    if (!equals.empty()) {
      out.verdict = Verdict::effect_class;
      out.members.push_back(best.fit.effects.front());
      std::vector<std::string> ids = {best.fit.effects.front().id};
      for (const Explanation& one : equals) {
        out.members.push_back(one.fit.effects.front());
        ids.push_back(one.fit.effects.front().id);
      }
      out.separate_by = separating_experiment(ids);
    }
  }
  out.evidence.scan_left = selection.largest_ratio(best);
  out.evidence.energy_left = best.fit.cost;
  out.evidence.local_left = comparison.local_score(best.weighted_residual(), best.law.group_excess());
  out.residual = best.weighted_residual();
  measure_gaps(comparison, holdout, selection, best, out);
  return out;
}

}  // namespace fatmc
