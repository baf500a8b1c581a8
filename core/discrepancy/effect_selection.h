// Forward, backward and swap steps over sets of effects.
#pragma once

#include <vector>

#include "core/discrepancy/candidate_scan.h"
#include "core/discrepancy/derivative_tolerance.h"
#include "core/discrepancy/diagnosis.h"
#include "core/discrepancy/effect_fit.h"
#include "core/discrepancy/fitted_law.h"

namespace fatmc {

/// A candidate is tried while its gain along the dictionary is within these of the leader's: interpolation and few flights err by
/// a hundredth of the discrepancy's energy at most.
constexpr double kCloseGain = 4.0 * kClassGain, kCloseShare = 0.01;

/// A set of effects at its best values, and what chance gives with it.
struct Explanation {
  EffectFit fit;
  FittedLaw law;
  std::size_t nuisances = 0;  ///< the first effects of the fit, which are never named
  bool adequate = false;      ///< what is left is what chance gives ...
  bool tolerated = false;     ///< ... and small errors of derivatives beside it (derivative_tolerance.h)

  /// Effects that the explanation names.
  [[nodiscard]] std::size_t named() const { return fit.effects.size() - nuisances; }

  /// Residual and Jacobian over the noise that the effects make.
  [[nodiscard]] Eigen::VectorXd weighted_residual() const {
    return fit.residual.cwiseQuotient(law.deviation());
  }
  [[nodiscard]] Eigen::MatrixXd weighted_jacobian() const {
    return law.deviation().cwiseInverse().asDiagonal() * fit.jacobian;
  }
};

class EffectSelection {
 public:
  EffectSelection(const Comparison& comparison, const Comparison* holdout, const DiagnosisOptions& options);

  /// The model as it is, nuisances at their best values.
  [[nodiscard]] const Explanation& nothing() const { return nothing_; }
  /// `base` with one more effect: the leading candidates fitted together with it, the best explanation first; only those whose
  /// likelihood along the dictionary is close to the best one's, or with `far` half of it.
  [[nodiscard]] std::vector<Explanation> extended(const Explanation& base, bool far) const;
  /// `two` or two others that explain more, found among all pairs (pair_scan.h).
  [[nodiscard]] Explanation paired(Explanation two) const;
  /// Errors of derivatives that would explain what is left.
  [[nodiscard]] DerivativeTolerance::Errors derivative_errors(const Explanation& e) const;
  /// Energy of the discrepancy above the floor.
  [[nodiscard]] double excess() const { return excess_; }
  [[nodiscard]] double scan_threshold() const { return comparison_.thresholds().scan; }
  /// What a further effect must gain; the first has passed the threshold of the scan when something was detected.
  [[nodiscard]] double required_gain(const Effect& effect, const FittedLaw& law, bool first) const;
  /// Whether the added effect earns its place: gain, held-out error, size.
  [[nodiscard]] bool accepted(const Explanation& without, const Explanation& with) const;
  /// Drops effects that no longer earn their place, and exchanges those with better rivals.
  [[nodiscard]] Explanation pruned(Explanation full) const;
  [[nodiscard]] Explanation exchanged(Explanation full) const;
  /// These effects at their best values; none where they cannot be flown.
  [[nodiscard]] std::optional<Explanation> explained(const std::vector<Effect>& start,
                                                     const FittedLaw& law) const;
  /// W^-1 (z - m) of the same effects fitted to the training rows alone; whole records held back: as it is.
  [[nodiscard]] Eigen::VectorXd trained_residual(const Explanation& e) const;
  /// Largest GLR of a further signature, in the coordinates of the explanation's law.
  [[nodiscard]] double largest_ratio(const Explanation& e) const;
  /// Gains, by the linear model and the dictionary, of an effect of the set and of the best one that could stand in its place.
  struct Alternative {
    double own = 0.0, rival = 0.0;
  };
  [[nodiscard]] Alternative alternative(const Explanation& e, std::size_t effect) const;
  /// |r|^2 of one explanation in the coordinates of another's law.
  [[nodiscard]] static double cost(const Explanation& e, const FittedLaw& law) {
    return e.fit.residual.cwiseQuotient(law.deviation()).squaredNorm();
  }

 private:
  [[nodiscard]] std::vector<Candidate> candidates(const Explanation& base) const;
  /// A fit with the law that its effects make, refined by it; none where they cannot be flown. `confirm`: an answer that
  /// is not adequate by little is looked at again with more flights.
  [[nodiscard]] std::optional<Explanation> judged(EffectFit fit, bool confirm) const;
  /// Moves to the optimum by the law's mean change and the linear model; returns what that gains.
  double take_linear_step(Explanation& e) const;
  [[nodiscard]] std::optional<Explanation> without(const Explanation& e, std::size_t effect) const;
  [[nodiscard]] double held_out_cost(const Explanation& e) const;
  [[nodiscard]] Explanation model_alone() const;
  void judge(Explanation& e) const;
  [[nodiscard]] bool is_adequate(const Explanation& e) const;
  [[nodiscard]] bool is_tolerable(const Explanation& e) const;
  [[nodiscard]] bool is_nearly_adequate(const Explanation& e) const;

  const Comparison& comparison_;
  const Comparison* holdout_;
  DiagnosisOptions options_;
  double excess_ = 0.0;  ///< energy of the discrepancy above the floor
  double local_ = 0.0;
  std::vector<int> training_, held_;
  DerivativeTolerance tolerance_;
  Explanation nothing_;
};

}  // namespace fatmc
