#include "core/discrepancy/diagnosis.h"

#include <algorithm>
#include <cmath>

#include "core/discrepancy/effect_knowledge.h"
#include "core/discrepancy/effect_selection.h"
#include "core/discrepancy/effect_size.h"

namespace fatmc {
namespace {

Gap gap_of(double before, double after, double floor, double count) {
  return {before / count, after / count, floor / count};
}

/// 95 % intervals of the effects' parameters.
std::vector<FoundEffect> found_effects(const EffectSelection& selection, const EffectFit& fit, int flights) {
  std::vector<FoundEffect> out;
  for (const Effect& effect : fit.effects) out.push_back({effect, {}, 0.0});
  const std::vector<FreeParameter> free = free_parameters(fit.effects);
  for (std::size_t i = 0; i < free.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double t = natural_value(fit.effects, free[i]);
    const double half = 1.959963984540054 * std::sqrt(fit.covariance(at, at));
    FoundEffect& found = out[static_cast<std::size_t>(free[i].effect)];
    const EffectParameter& kind = found.effect.kind().parameters[static_cast<std::size_t>(free[i].parameter)];
    const auto back = [&](double x) { return from_natural(kind, std::clamp(x, free[i].low, free[i].high)); };
    found.parameters.push_back(
        {std::string(kind.name), std::string(kind.unit), back(t), back(t - half), back(t + half)});
  }
  if (out.size() == 1) {
    out.front().gain = selection.nothing().cost - fit.cost;
    return out;
  }
  for (std::size_t e = 0; e < out.size(); ++e) {
    std::vector<Effect> rest = fit.effects;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(e));
    const EffectFit less = selection.refitted(rest, flights);
    if (less.usable()) out[e].gain = less.cost - fit.cost;
  }
  return out;
}

/// What the largest GLR of a further signature exceeds by chance in 1 % of records where the effects found so far shape the
/// noise: from flights of the model with them. An effect that lets the aircraft bank further, say, scatters means and trims
/// more than the model's own law allows, and would be followed by a bias that is none. 0 where a flight leaves the model.
double scan_limit(const Comparison& comparison, const EffectFit& fit) {
  constexpr int kFlights = 60;
  const std::vector<std::vector<Effect>> sets = {fit.effects};
  Eigen::MatrixXd z(comparison.size(), kFlights);
  for (std::size_t i = 0; i < comparison.records().size(); ++i) {
    const ComparedRecord& record = comparison.records()[i];
    const EffectFlights flown = record.model->fly(sets, ComparisonBasis::kBaseline, kFlights, 1).front();
    if (!flown.usable()) return 0.0;
    const Eigen::VectorXd mean = flown.features.rowwise().mean();
    z.middleRows(comparison.first_row(i), record.basis->layout.size) =
        record.basis->law.whiten(record.basis->layout, flown.features.colwise() - mean);
  }
  std::vector<double> largest;
  for (int n = 0; n < kFlights; ++n) {
    double most = 0.0;
    for (const ScanHit& hit : scan_signatures(z.col(n), comparison.atoms(), fit.jacobian))
      most = std::max(most, hit.glr);
    largest.push_back(most);
  }
  return tail_quantile(std::move(largest), 0.01);
}

/// Rivals of the last effect that explain the records as well.
std::vector<EffectFit> equals_of(const EffectSelection& selection, const EffectFit& best,
                                 std::vector<EffectFit> rivals, int flights) {
  std::vector<EffectFit> out;
  for (EffectFit& rival : rivals) {
    if (rival.effects.back().name() == best.effects.back().name()) continue;
    if (rival.effects.size() != best.effects.size()) continue;
    if (rival.cost > best.cost + 4.0 * kClassGain) continue;  // screening is coarse
    rival = selection.refitted(rival.effects, flights);
    if (rival.usable() && rival.cost < best.cost + kClassGain && selection.adequate(rival))
      out.push_back(rival);
  }
  return out;
}

void measure_gaps(const Comparison& comparison, const Comparison* holdout, const EffectSelection& selection,
                  const EffectFit& fit, const DiagnosisOptions& options, Diagnosis& out) {
  const double all = static_cast<double>(comparison.size());
  const double mean = comparison.thresholds().energy_mean / all;
  if (holdout != nullptr) {
    const auto held = static_cast<double>(holdout->size());
    out.holdout_lines = false;
    out.training =
        gap_of(comparison.discrepancy().squaredNorm(), fit.residual.squaredNorm(), mean * all, all);
    double after = holdout->discrepancy().squaredNorm();
    if (!fit.effects.empty()) {
      const std::vector<std::vector<Effect>> sets = {fit.effects};
      after = (holdout->discrepancy() - holdout->changes(sets, options.final_flights).col(0)).squaredNorm();
    }
    out.holdout =
        gap_of(holdout->discrepancy().squaredNorm(), after, holdout->thresholds().energy_mean, held);
    return;
  }
  const std::vector<int> training = comparison.training_rows(), held = comparison.held_out_rows();
  const Eigen::VectorXd residual = selection.trained_residual(fit);
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
  EffectFit fit = selection.nothing();
  const std::vector<ScanHit> first = selection.hits(fit);
  out.evidence.scan = first.empty() ? 0.0 : first.front().glr;
  if (!first.empty()) {
    out.evidence.leading =
        comparison.dictionary().atoms[static_cast<std::size_t>(first.front().atom)].effect.name();
  }
  out.evidence.energy = fit.cost;
  out.evidence.local = comparison.local_score(fit.residual);
  const bool detected = out.evidence.scan > limit.scan || out.evidence.energy > limit.energy ||
                        out.evidence.local > limit.local;

  std::vector<EffectFit> rivals;
  while (detected && static_cast<int>(fit.effects.size()) < options.most_effects) {
    // Half of what is required: the linear ratio of a signature may fall short of the fit's gain.
    const std::vector<ScanHit> hits = selection.hits(fit);
    if (hits.empty() || hits.front().glr < 0.5 * limit.scan) break;
    std::vector<EffectFit> next = selection.extended(fit);
    if (next.empty() || !selection.accepted(fit, next.front(), next.front().effects.back())) break;
    if (!fit.effects.empty() && fit.cost - next.front().cost < scan_limit(comparison, fit)) break;
    fit = selection.exchanged(selection.pruned(next.front()));
    if (fit.effects.size() == 1) rivals = std::move(next);
  }
  if (!fit.effects.empty()) {
    EffectFit refined = selection.refitted(fit.effects, options.final_flights);
    if (refined.usable()) fit = std::move(refined);
  }

  const bool adequate = selection.adequate(fit);
  if (!fit.effects.empty()) out.effects = found_effects(selection, fit, options.screening_flights);
  if (fit.effects.empty()) {
    out.verdict = adequate ? Verdict::none : Verdict::unknown;
  } else {
    out.verdict = adequate ? Verdict::named : Verdict::unknown;
    if (fit.effects.size() == 1 && adequate) {
      const std::vector<EffectFit> equals =
          equals_of(selection, fit, std::move(rivals), options.final_flights);
      if (!equals.empty()) {
        out.verdict = Verdict::effect_class;
        out.members.push_back(fit.effects.front());
        std::vector<std::string> ids = {fit.effects.front().id};
        for (const EffectFit& one : equals) {
          out.members.push_back(one.effects.front());
          ids.push_back(one.effects.front().id);
        }
        out.separate_by = separating_experiment(ids);
      }
    }
  }
  const std::vector<ScanHit> left = selection.hits(fit);
  out.evidence.scan_left = left.empty() ? 0.0 : left.front().glr;
  out.evidence.energy_left = fit.residual.squaredNorm();
  out.evidence.local_left = comparison.local_score(fit.residual);
  out.residual = fit.residual;
  measure_gaps(comparison, holdout, selection, fit, options, out);
  return out;
}

}  // namespace fatmc
