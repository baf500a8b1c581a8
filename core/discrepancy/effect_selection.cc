#include "core/discrepancy/effect_selection.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/discrepancy/effect_size.h"
#include "core/discrepancy/signature_scan.h"

namespace fatmc {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Squared change of what is held back, in deviations, from which on it must be a change for the better: three deviations.
constexpr double kVisible = 9.0;

/// Where nothing close is adequate, up to this share of its gain.
constexpr double kFarShare = 0.5;
/// A step of the estimate that gains more than this is taken by flights again, a smaller one by the linear model.
constexpr double kLinearGain = 25.0;
/// What is above its limits by less than these factors may be so because the law is of few flights.
constexpr double kNearEnergy = 1.3, kNearLocal = 5.0;
constexpr int kConfirmingFlights = 64;

}  // namespace

EffectSelection::EffectSelection(const Comparison& comparison, const Comparison* holdout,
                                 const DiagnosisOptions& options)
    : comparison_(comparison),
      holdout_(holdout),
      options_(options),
      tolerance_(comparison, options.excluded),
      nothing_{{}, FittedLaw(comparison)} {
  excess_ = std::max(0.0, comparison.discrepancy().squaredNorm() - comparison.thresholds().energy_mean);
  local_ = comparison.local_score(comparison.discrepancy());
  if (holdout == nullptr) {
    training_ = comparison.training_rows();
    held_ = comparison.held_out_rows();
  }
  nothing_ = model_alone();
  if (!options.nuisances.empty()) {
    if (auto fitted = explained(options.nuisances, nothing_.law)) nothing_ = std::move(*fitted);
  }
}

Explanation EffectSelection::model_alone() const {
  Explanation out{{}, FittedLaw(comparison_)};
  out.fit.ending = EffectFit::Ending::converged;
  out.fit.residual = comparison_.discrepancy();
  out.fit.cost = out.fit.residual.squaredNorm();
  out.fit.jacobian.resize(comparison_.size(), 0);
  judge(out);
  return out;
}

std::vector<Candidate> EffectSelection::candidates(const Explanation& base) const {
  std::vector<Candidate> out =
      scan_candidates(comparison_, base.fit.residual, base.fit.jacobian, base.law.deviation());
  std::erase_if(out, [&](const Candidate& c) {
    const std::string name = c.effect.name();
    const auto& excluded = options_.excluded;
    return std::find(excluded.begin(), excluded.end(), c.effect.id) != excluded.end() ||
           std::any_of(base.fit.effects.begin(), base.fit.effects.end(),
                       [&](const Effect& e) { return e.name() == name; });
  });
  return out;
}

double EffectSelection::largest_ratio(const Explanation& e) const {
  const Matrix atoms = e.law.deviation().cwiseInverse().asDiagonal() * comparison_.atoms();
  double most = 0.0;
  for (const ScanHit& hit : scan_signatures(e.weighted_residual(), atoms, e.weighted_jacobian())) {
    const Effect& effect = comparison_.dictionary().atoms[static_cast<std::size_t>(hit.atom)].effect;
    const auto& excluded = options_.excluded;
    if (std::find(excluded.begin(), excluded.end(), effect.id) == excluded.end())
      most = std::max(most, hit.glr);
  }
  return most;
}

std::optional<Explanation> EffectSelection::judged(EffectFit fit, bool confirm) const {
  const FitOptions options{options_.fit_flights};
  for (int round = 0; fit.usable() && round < 2; ++round) {
    auto law = FittedLaw::of(comparison_, fit.effects, FittedLaw::kFlights);
    if (!law) return std::nullopt;
    Explanation out{std::move(fit), std::move(*law), options_.nuisances.size()};
    const double gain = take_linear_step(out);
    if (gain > kLinearGain && round == 0) {
      fit = fit_effects(comparison_, out.fit.effects, out.law.deviation(), options);
      continue;
    }
    judge(out);
    if (confirm && !out.adequate && is_nearly_adequate(out)) {
      // The law of few flights is itself uncertain: looked at again with more of them before the answer is "unknown".
      if (auto more = FittedLaw::of(comparison_, out.fit.effects, kConfirmingFlights)) {
        out.law = std::move(*more);
        take_linear_step(out);
        judge(out);
      }
    }
    return out;
  }
  return std::nullopt;
}

double EffectSelection::take_linear_step(Explanation& e) const {
  e.fit.residual = comparison_.discrepancy() - e.law.change();
  const Matrix j = e.weighted_jacobian();
  const Vector step = linear_step(e.fit.effects, j, e.weighted_residual());
  e.fit.effects = moved(std::move(e.fit.effects), step);
  e.fit.residual -= e.fit.jacobian * step;
  e.fit.cost = e.weighted_residual().squaredNorm();
  return (j * step).squaredNorm();
}

std::optional<Explanation> EffectSelection::explained(const std::vector<Effect>& start,
                                                      const FittedLaw& law) const {
  return judged(fit_effects(comparison_, start, law.deviation(), {options_.fit_flights}), false);
}

std::vector<Explanation> EffectSelection::extended(const Explanation& base, bool far) const {
  const std::vector<Candidate> leading = candidates(base);
  std::vector<EffectFit> fits;
  for (std::size_t i = 0; i < leading.size() && i < static_cast<std::size_t>(options_.rivals); ++i) {
    const double first = leading.front().gain;
    if (leading[i].gain < (far ? kFarShare * first : first - kCloseGain - kCloseShare * first)) break;
    std::vector<Effect> start = base.fit.effects;
    start.push_back(leading[i].effect);
    EffectFit fit = fit_effects(comparison_, std::move(start), base.law.deviation(), {options_.fit_flights});
    if (fit.usable()) fits.push_back(std::move(fit));
  }
  std::stable_sort(fits.begin(), fits.end(),
                   [](const EffectFit& a, const EffectFit& b) { return a.cost < b.cost; });
  std::vector<Explanation> out;
  const double best = fits.empty() ? 0.0 : fits.front().cost;
  for (EffectFit& fit : fits) {
    if (fit.cost > best + kCloseGain) break;
    if (auto one = judged(std::move(fit), out.empty())) out.push_back(std::move(*one));
  }
  if (out.empty()) return out;
  // Each in the coordinates of the first one's law: they differ little where costs are close.
  const FittedLaw law = out.front().law;
  std::stable_sort(out.begin(), out.end(),
                   [&](const Explanation& a, const Explanation& b) { return cost(a, law) < cost(b, law); });
  return out;
}

double EffectSelection::required_gain(const Effect& effect, const FittedLaw& law, bool first) const {
  const auto p = static_cast<double>(effect.values.size());
  const auto v = static_cast<double>(comparison_.dictionary().variants.size());
  const double named = 2.0 * p * std::log(v / kNamingLevel);
  return (first ? named : std::max(comparison_.thresholds().scan * law.scan_ratio(), named)) +
         kMaterialShare * excess_;
}

bool EffectSelection::accepted(const Explanation& without, const Explanation& with) const {
  const Effect& added = with.fit.effects.back();
  const double gain = cost(without, with.law) - with.fit.cost;
  if (gain < required_gain(added, without.law, without.named() == 0)) return false;
  if (relative_size(added) < kMaterialSize) return false;
  // With another effect still missing, a fit of one may well raise the error where the other acts.
  if (!with.adequate) return true;
  if (holdout_ == nullptr) {
    // Lines show nothing of an effect on noise or trim alone.
    double shown = 0.0;
    for (const int row : held_) {
      shown += std::pow((with.fit.residual[row] - without.fit.residual[row]) / with.law.deviation()[row], 2);
    }
    if (shown < kVisible) return true;
    Explanation before = without;
    before.law = with.law;
    return held_out_cost(with) < held_out_cost(before);
  }
  return held_out_cost(with) < held_out_cost(without);
}

// From the fit to all rows the optimum on the training rows is one linear step away: dt = (J^T J)^-1 J^T r over those rows.
Vector EffectSelection::trained_residual(const Explanation& e) const {
  const Vector r = e.weighted_residual();
  if (e.fit.jacobian.cols() == 0 || holdout_ != nullptr) return r;
  const Matrix j = e.weighted_jacobian();
  const Matrix part = j(training_, Eigen::all);
  const Matrix normal = part.transpose() * part;
  const Vector step = normal.completeOrthogonalDecomposition().solve(part.transpose() * r(training_));
  return r - j * step;
}

double EffectSelection::held_out_cost(const Explanation& e) const {
  if (holdout_ == nullptr) return trained_residual(e)(held_).squaredNorm();
  if (e.fit.effects.empty()) return holdout_->discrepancy().squaredNorm();
  const std::vector<std::vector<Effect>> sets = {e.fit.effects};
  const double left =
      (holdout_->discrepancy() - holdout_->changes(sets, ComparisonBasis::kBaseline).col(0)).squaredNorm();
  return std::isfinite(left) ? left : std::numeric_limits<double>::infinity();
}

bool EffectSelection::is_adequate(const Explanation& e) const {
  const Thresholds& limit = comparison_.thresholds();
  const Vector r = e.weighted_residual();
  return r.squaredNorm() <= limit.energy + e.law.excess() + kResolution * excess_ &&
         comparison_.local_score(r, e.law.group_excess()) <=
             limit.local + kResolution * std::max(0.0, local_);
}

bool EffectSelection::is_tolerable(const Explanation& e) const {
  const Thresholds& limit = comparison_.thresholds();
  const DerivativeTolerance::Errors errors = derivative_errors(e);
  return errors.energy <= limit.energy + e.law.excess() + kResolution * excess_ &&
         comparison_.local_score(errors.residual, e.law.group_excess()) <=
             limit.local + kResolution * std::max(0.0, local_);
}

DerivativeTolerance::Errors EffectSelection::derivative_errors(const Explanation& e) const {
  return tolerance_.errors(e.fit.effects, e.weighted_residual(), e.weighted_jacobian(), e.law.deviation());
}

// That derivatives are off is no explanation of its own: what was detected and is that is found as an effect.
void EffectSelection::judge(Explanation& e) const {
  const bool strictly = is_adequate(e);
  e.tolerated = !strictly && e.named() > 0 && is_tolerable(e);
  e.adequate = strictly || e.tolerated;
}

bool EffectSelection::is_nearly_adequate(const Explanation& e) const {
  const Thresholds& limit = comparison_.thresholds();
  const Vector r = e.weighted_residual();
  return r.squaredNorm() <= kNearEnergy * (limit.energy + e.law.excess()) + kResolution * excess_ &&
         comparison_.local_score(r, e.law.group_excess()) <=
             kNearLocal * limit.local + kResolution * std::max(0.0, local_);
}

std::optional<Explanation> EffectSelection::without(const Explanation& e, std::size_t effect) const {
  std::vector<Effect> left = e.fit.effects;
  left.erase(left.begin() + static_cast<std::ptrdiff_t>(effect));
  if (left.size() == e.nuisances) return nothing();
  return explained(left, e.law);
}

EffectSelection::Alternative EffectSelection::alternative(const Explanation& e, std::size_t effect) const {
  Explanation rest{{}, e.law};
  rest.fit.effects = e.fit.effects;
  rest.fit.effects.erase(rest.fit.effects.begin() + static_cast<std::ptrdiff_t>(effect));
  rest.fit.residual = e.fit.residual;
  const std::vector<FreeParameter> free = free_parameters(e.fit.effects);
  std::vector<int> others;
  for (std::size_t i = 0; i < free.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const EffectParameter& p =
        e.fit.effects[effect].kind().parameters[static_cast<std::size_t>(free[i].parameter)];
    if (free[i].effect != static_cast<int>(effect)) {
      others.push_back(static_cast<int>(i));
    } else if (p.strength && !is_limit(p)) {
      const double distance = natural_value(e.fit.effects, free[i]) - to_natural(p, p.nominal);
      rest.fit.residual += distance * e.fit.jacobian.col(at);
    }
  }
  rest.fit.jacobian = e.fit.jacobian(Eigen::all, others);
  Alternative out;
  const std::string name = e.fit.effects[effect].name();
  for (const Candidate& c : candidates(rest)) {
    double& gain = c.effect.name() == name ? out.own : out.rival;
    gain = std::max(gain, c.gain);
  }
  return out;
}

}  // namespace fatmc
