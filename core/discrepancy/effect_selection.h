// Forward, backward and swap steps over sets of effects.
#pragma once

#include <vector>

#include "core/discrepancy/diagnosis.h"
#include "core/discrepancy/effect_fit.h"
#include "core/discrepancy/signature_scan.h"

namespace fatmc {

class EffectSelection {
 public:
  EffectSelection(const Comparison& comparison, const Comparison* holdout, const DiagnosisOptions& options);

  /// The model as it is.
  [[nodiscard]] EffectFit nothing() const;
  /// `base` with one more effect, the leading signatures on its residual fitted together with it, best fit first.
  [[nodiscard]] std::vector<EffectFit> extended(const EffectFit& base) const;
  /// What the last effect of `fit` must gain over a fit without it.
  [[nodiscard]] double required_gain(const Effect& effect) const;
  /// Whether the added effect earns its place: gain, held-out error, size.
  [[nodiscard]] bool accepted(const EffectFit& without, const EffectFit& with, const Effect& added) const;
  /// Drops effects that no longer earn their place, and exchanges those with better rivals.
  [[nodiscard]] EffectFit pruned(EffectFit fit) const;
  [[nodiscard]] EffectFit exchanged(EffectFit fit) const;
  [[nodiscard]] EffectFit refitted(const std::vector<Effect>& effects, int flights) const;
  /// Residual, all rows, of the same effects fitted to the training rows alone; whole records held back: as it is.
  [[nodiscard]] Eigen::VectorXd trained_residual(const EffectFit& fit) const;
  /// |z - m|^2 on what is held back, of effects fitted to the rest.
  [[nodiscard]] double held_out_cost(const EffectFit& fit) const;
  /// What is left is what chance gives.
  [[nodiscard]] bool adequate(const EffectFit& fit) const;
  /// Largest GLR of the candidates on a residual, with the hit's atom.
  [[nodiscard]] std::vector<ScanHit> hits(const EffectFit& base) const;

 private:
  [[nodiscard]] EffectFit without(const EffectFit& fit, std::size_t effect) const;

  const Comparison& comparison_;
  const Comparison* holdout_;
  DiagnosisOptions options_;
  double excess_ = 0.0;  ///< energy of the discrepancy above the floor
  double local_ = 0.0;
  std::vector<int> training_, held_;
};

}  // namespace fatmc
