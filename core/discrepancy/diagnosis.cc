#include "core/discrepancy/diagnosis.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/text.h"
#include "core/discrepancy/effect_knowledge.h"
#include "core/discrepancy/effect_selection.h"
#include "core/discrepancy/effect_size.h"
#include "core/discrepancy/level_probe.h"
#include "core/discrepancy/moment_filters.h"
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

/// 95 % intervals of the effects' parameters: t +- quantile times deviation of (J^T W^-2 J)^-1 J^T W^-2 r (fitted_law.h), with what
/// tolerated errors of derivatives move.
std::vector<FoundEffect> found_effects(const EffectSelection& selection, const Explanation& e) {
  std::vector<Effect> effects = e.fit.effects;
  const std::vector<FreeParameter> free = free_parameters(effects);
  const Eigen::MatrixXd j = e.weighted_jacobian();
  const Eigen::MatrixXd inverse = j.completeOrthogonalDecomposition().pseudoInverse();
  const FittedLaw::Spread spread = e.law.spread(inverse * e.law.deviation().cwiseInverse().asDiagonal());
  Eigen::VectorXd deviation = spread.deviation;
  if (e.tolerated) {
    const DerivativeTolerance::Errors errors = selection.derivative_errors(e);
    effects = moved(std::move(effects), errors.shift);
    deviation =
        (deviation.array().square() + errors.shift_covariance.diagonal().array()).max(0.0).sqrt().matrix();
  }
  std::vector<FoundEffect> out;
  for (const Effect& effect : effects) out.push_back({effect, {}, 0.0});
  for (std::size_t i = 0; i < free.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double t = natural_value(effects, free[i]);
    const double half = t_quantile(0.975, spread.dof[at]) * deviation[at];
    FoundEffect& found = out[static_cast<std::size_t>(free[i].effect)];
    const EffectParameter& kind = found.effect.kind().parameters[static_cast<std::size_t>(free[i].parameter)];
    const auto back = [&](double x) { return from_natural(kind, std::clamp(x, free[i].low, free[i].high)); };
    found.parameters.push_back(
        {std::string(kind.name), std::string(kind.unit), back(t), back(t - half), back(t + half)});
  }
  for (std::size_t i = e.nuisances; i < out.size(); ++i) {
    out[i].gain = e.named() == 1 ? EffectSelection::cost(selection.nothing(), e.law) - e.fit.cost
                                 : selection.alternative(e, i).own;
  }
  out.erase(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(e.nuisances));
  return out;
}

/// Which derivatives would explain what is left, one sentence.
std::string tolerance_note(const EffectSelection& selection, const Explanation& e) {
  const DerivativeTolerance::Errors errors = selection.derivative_errors(e);
  std::string list;
  for (std::size_t i = 0; i < errors.derivatives.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double deviation = std::sqrt(errors.covariance(at, at));
    if (std::abs(errors.log_factor[at]) < deviation) continue;
    list += (list.empty() ? "" : ", ") + errors.derivatives[i].name() + " times " +
            significant(std::exp(errors.log_factor[at]), 3) + " +- " + significant(deviation, 2);
  }
  return "What is left beyond chance is within what derivatives known to " +
         significant(100.0 * DerivativeTolerance::kShare, 2) + " % may be off: " + list + ".";
}

std::vector<MomentOutput> moment_outputs(const ComparedRecord& record) {
  std::vector<MomentOutput> out;
  const FeatureBlock& block = record.basis->layout.blocks.back();
  const auto& moments = higher_moments();
  if (block.kind != FeatureKind::moment) return out;
  const bool all = static_cast<std::size_t>(block.size()) == moments.size();
  for (int i = 0; i < block.size(); ++i) {
    const std::string axis =
        "axis " +
        record.basis->layout.channels[static_cast<std::size_t>(block.channels[static_cast<std::size_t>(i)])];
    out.push_back({all ? moments[static_cast<std::size_t>(i)].name() : axis, record.features[block.first + i],
                   record.basis->law.mean[block.first + i]});
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
  const auto most = static_cast<std::size_t>(options.most_effects);
  Explanation best = selection.nothing();
  rivals.clear();
  for (int step = 0; step <= options.most_effects + 1; ++step) {
    // Half of what is required: the linear ratio of a signature may fall short of the fit's gain.
    if (best.adequate &&
        (best.named() == most || selection.largest_ratio(best) < 0.5 * selection.scan_threshold()))
      break;
    const bool first = best.named() == 0;
    std::vector<Explanation> next = selection.extended(best, far && first);
    if (far && first) std::erase_if(next, [](const Explanation& e) { return !e.adequate; });
    const auto taken = std::find_if(next.begin(), next.end(),
                                    [&](const Explanation& e) { return selection.accepted(best, e); });
    if (taken == next.end()) break;
    Explanation with = *taken;
    if (with.named() == 1) rivals = std::move(next);
    if (with.named() == 2) with = selection.paired(std::move(with));
    if (with.named() > 1) with = selection.exchanged(selection.pruned(std::move(with)));
    if (with.named() > most) break;  // none of them was a mistake
    const bool back = with.named() <= best.named();
    if (back && EffectSelection::cost(with, best.law) >= best.fit.cost) break;
    best = std::move(with);
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
    if (!e.fit.effects.empty()) {  // nuisances included
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
  out.evidence.local = comparison.local_score(best.weighted_residual(), best.law.group_excess());
  const bool found = out.evidence.scan > limit.scan * best.law.scan_ratio() ||
                     out.evidence.energy > limit.energy + best.law.excess() ||
                     out.evidence.local > limit.local;
  const LevelProbe first = probe_level(comparison, best, LevelProbe::kNothing, 0.0);
  const bool detected = found || first.failed();

  std::vector<Explanation> rivals;
  if (found) {
    best = searched(selection, options, false, rivals);
    // Nothing close to the leading candidate explains it: others have their turn before the answer is "unknown".
    if (!best.adequate) {
      Explanation other = searched(selection, options, true, rivals);
      if (other.adequate || best.named() == 0) best = std::move(other);
    }
  }

  if (best.named() > 0) out.effects = found_effects(selection, best);
  out.environment.assign(best.fit.effects.begin(),
                         best.fit.effects.begin() + static_cast<std::ptrdiff_t>(best.nuisances));
  const LevelProbe level = best.fit.effects.empty() ? first
                                                    : probe_level(comparison, best, LevelProbe::kNamed,
                                                                  kResolution * selection.excess());
  if (level.failed()) out.notes.push_back(level.statement());
  out.evidence.level = level.score;
  out.evidence.level_limit = level.limit;
  out.evidence.moments = moment_outputs(comparison.records().front());
  // What was detected and no effect accounts for is unknown, even where energy and groups alone would not show it.
  if (best.named() == 0) {
    out.verdict = detected ? Verdict::unknown : Verdict::none;
  } else {
    out.verdict = best.adequate && !level.failed() ? Verdict::named : Verdict::unknown;
    if (best.tolerated) out.notes.push_back(tolerance_note(selection, best));
  }
  if (out.verdict == Verdict::named && best.named() == 1) {
    const std::vector<Explanation> equals = equals_of(best, std::move(rivals));
    if (!equals.empty()) {
      out.verdict = Verdict::effect_class;
      out.members.push_back(best.fit.effects.back());
      std::vector<std::string> ids = {best.fit.effects.back().id};
      for (const Explanation& one : equals) {
        out.members.push_back(one.fit.effects.back());
        ids.push_back(one.fit.effects.back().id);
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
