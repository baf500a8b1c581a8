#include "core/discrepancy/effect_selection.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/discrepancy/effect_size.h"

namespace fatmc {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Flights for the law of what a fitted effect leaves: 9 % of a deviation, 14 % of a variance of one feature.
constexpr int kLawFlights = 100;

/// Squared change of what is held back, in deviations, from which on it must be a change for the better: three deviations.
constexpr double kVisible = 9.0;

/// The effect of a signature, scaled by the amplitude that the scan gives it.
Effect scaled(const Effect& signature, double amplitude) {
  const EffectKind& kind = signature.kind();
  Effect out = signature;
  for (std::size_t p = 0; p < kind.parameters.size(); ++p) {
    const EffectParameter& parameter = kind.parameters[p];
    if (!parameter.strength || is_limit(parameter)) continue;
    out.values[p] = std::clamp(parameter.toward(signature.values[p], std::clamp(amplitude, 0.05, 4.0)),
                               parameter.low, parameter.high);
  }
  return out;
}

}  // namespace

EffectSelection::EffectSelection(const Comparison& comparison, const Comparison* holdout,
                                 const DiagnosisOptions& options)
    : comparison_(comparison), holdout_(holdout), options_(options) {
  excess_ = std::max(0.0, comparison.discrepancy().squaredNorm() - comparison.thresholds().energy_mean);
  local_ = comparison.local_score(comparison.discrepancy());
  if (holdout == nullptr) {
    training_ = comparison.training_rows();
    held_ = comparison.held_out_rows();
  }
}

EffectFit EffectSelection::nothing() const {
  EffectFit out;
  out.ending = EffectFit::Ending::converged;
  out.residual = comparison_.discrepancy();
  out.cost = out.residual.squaredNorm();
  out.jacobian.resize(comparison_.size(), 0);
  return out;
}

std::vector<ScanHit> EffectSelection::hits(const EffectFit& base) const {
  const Dictionary& dictionary = comparison_.dictionary();
  const std::vector<ScanHit> all = scan_signatures(base.residual, comparison_.atoms(), base.jacobian);
  // The best signature of every candidate that is not in the set.
  std::vector<ScanHit> best(dictionary.variants.size());
  for (const ScanHit& hit : all) {
    const auto v = static_cast<std::size_t>(dictionary.atoms[static_cast<std::size_t>(hit.atom)].variant);
    const std::string variant = dictionary.variants[v].name();
    const auto& excluded = options_.excluded;
    if (std::find(excluded.begin(), excluded.end(), dictionary.variants[v].id) != excluded.end()) continue;
    const bool used = std::any_of(base.effects.begin(), base.effects.end(),
                                  [&](const Effect& e) { return e.name() == variant; });
    if (!used && hit.glr > best[v].glr) best[v] = hit;
  }
  std::erase_if(best, [](const ScanHit& hit) { return hit.atom < 0; });
  std::stable_sort(best.begin(), best.end(),
                   [](const ScanHit& a, const ScanHit& b) { return a.glr > b.glr; });
  return best;
}

std::vector<EffectFit> EffectSelection::extended(const EffectFit& base) const {
  const FitOptions fit{options_.screening_flights, 5, 0.1, 1e-3};
  std::vector<EffectFit> out;
  const std::vector<ScanHit> leading = hits(base);
  for (std::size_t i = 0; i < leading.size() && i < static_cast<std::size_t>(options_.rivals); ++i) {
    // Signatures are taken at two sizes, so that a rival whose best one has a small part of the leader's likelihood gain does
    // not overtake it by its curvature; the second is always tried, unless it is far off.
    if (leading[i].glr < (i == 1 ? 0.3 : 0.6) * leading.front().glr) break;
    std::vector<Effect> start = base.effects;
    start.push_back(scaled(comparison_.dictionary().atoms[static_cast<std::size_t>(leading[i].atom)].effect,
                           leading[i].amplitude));
    EffectFit one = fit_effects(comparison_, std::move(start), {}, fit);
    if (one.usable()) out.push_back(std::move(one));
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const EffectFit& a, const EffectFit& b) { return a.cost < b.cost; });
  return out;
}

double EffectSelection::required_gain(const Effect& effect) const {
  const auto p = static_cast<double>(effect.values.size());
  const auto v = static_cast<double>(comparison_.dictionary().variants.size());
  return std::max(comparison_.thresholds().scan, 2.0 * p * std::log(v / kNamingLevel)) +
         kMaterialShare * excess_;
}

bool EffectSelection::accepted(const EffectFit& without, const EffectFit& with, const Effect& added) const {
  if (without.cost - with.cost < required_gain(added)) return false;
  if (relative_size(added) < kMaterialSize) return false;
  if (holdout_ == nullptr) {
    // Lines show nothing of an effect on noise or trim alone.
    double shown = 0.0;
    for (const int row : held_) shown += std::pow(with.residual[row] - without.residual[row], 2);
    if (shown < kVisible) return true;
  }
  return held_out_cost(with) < held_out_cost(without);
}

EffectFit EffectSelection::refitted(const std::vector<Effect>& effects, int flights) const {
  if (effects.empty()) return nothing();
  return fit_effects(comparison_, effects, {}, {flights, 5, 0.05, 1e-4});
}

// From the fit to all rows the optimum on the training rows is one linear step away: dt = (J^T J)^-1 J^T r over those rows.
Vector EffectSelection::trained_residual(const EffectFit& fit) const {
  if (fit.jacobian.cols() == 0 || holdout_ != nullptr) return fit.residual;
  Matrix j(static_cast<Eigen::Index>(training_.size()), fit.jacobian.cols());
  Vector r(j.rows());
  for (std::size_t i = 0; i < training_.size(); ++i) {
    j.row(static_cast<Eigen::Index>(i)) = fit.jacobian.row(training_[i]);
    r[static_cast<Eigen::Index>(i)] = fit.residual[training_[i]];
  }
  const Matrix normal = j.transpose() * j;
  const Vector step = normal.completeOrthogonalDecomposition().solve(j.transpose() * r);
  return fit.residual - fit.jacobian * step;
}

double EffectSelection::held_out_cost(const EffectFit& fit) const {
  if (holdout_ == nullptr) {
    const Vector residual = trained_residual(fit);
    double sum = 0.0;
    for (const int row : held_) sum += residual[row] * residual[row];
    return sum;
  }
  if (fit.effects.empty()) return holdout_->discrepancy().squaredNorm();
  const std::vector<std::vector<Effect>> sets = {fit.effects};
  const double cost =
      (holdout_->discrepancy() - holdout_->changes(sets, options_.final_flights).col(0)).squaredNorm();
  return std::isfinite(cost) ? cost : std::numeric_limits<double>::infinity();
}

bool EffectSelection::adequate(const EffectFit& fit) const {
  const Thresholds& limit = comparison_.thresholds();
  const double energy = fit.residual.squaredNorm();
  const double local = comparison_.local_score(fit.residual);
  const double allowed_local = limit.local + kResolution * std::max(0.0, local_);
  if (energy <= limit.energy + kResolution * excess_ && local <= allowed_local) return true;
  if (fit.effects.empty()) return false;
  // An effect changes the noise as well: what chance gives is then read from flights of the model with it.
  const auto law = comparison_.residual_law(fit.effects, kLawFlights);
  if (!law) return false;
  return energy <= limit.energy * law->energy_mean / limit.energy_mean + kResolution * excess_ &&
         comparison_.local_score(fit.residual, *law) <= allowed_local;
}

EffectFit EffectSelection::without(const EffectFit& fit, std::size_t effect) const {
  std::vector<Effect> left = fit.effects;
  left.erase(left.begin() + static_cast<std::ptrdiff_t>(effect));
  return refitted(left, options_.screening_flights);
}

EffectFit EffectSelection::pruned(EffectFit fit) const {
  for (std::size_t e = 0; fit.effects.size() > 1 && e < fit.effects.size();) {
    EffectFit less = without(fit, e);
    if (less.usable() && less.cost - fit.cost < required_gain(fit.effects[e])) {
      fit = std::move(less);
      e = 0;
    } else {
      ++e;
    }
  }
  return fit;
}

EffectFit EffectSelection::exchanged(EffectFit fit) const {
  for (std::size_t e = 0; fit.effects.size() > 1 && e < fit.effects.size(); ++e) {
    const EffectFit less = without(fit, e);
    if (!less.usable()) continue;
    std::vector<EffectFit> rivals = extended(less);
    if (!rivals.empty() && rivals.front().cost < fit.cost - 1.0) fit = std::move(rivals.front());
  }
  return fit;
}

}  // namespace fatmc
