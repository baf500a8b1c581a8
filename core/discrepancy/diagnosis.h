// From a comparison to an answer: nothing missing, a named effect, a class of effects that these records cannot separate, or
// something that no known effect explains.
//
// 1. Detect: largest signature GLR, energy z^T z, largest local group, each against its own threshold (Thresholds).
// 2. Name: likelihoods are followed along the dictionary (candidate_scan.h); the leading candidates, as far as they are close, are
//    fitted with real simulations. The best is taken if it gains more than max(scan threshold, 2 p ln(V/alpha)) for p
//    parameters and V candidates, lowers the error on what is held back, and is material. Then the next, on what is left
//    (forward), by the law of chance that the effects so far make (fitted_law.h); effects that have lost their gain are
//    dropped (backward); each is tried against its rivals (swap), two against other pairs (pair_scan.h). One effect more than may be
//    named is tried where that leaves something: it may show which of those before was there by mistake.
// 3. Judge: the residual must be what chance gives with the effects, the error of the mean over few flights included, but for
//    kResolution of the discrepancy, or what small errors of the derivatives explain (derivative_tolerance.h). Else the answer is unknown.
//    Nor may it show that a value depends on level (level_probe.h): a derivative that grows with the motion is not that derivative.
// 4. Class: rivals whose fits are as good to within kClassGain.
#pragma once

#include <string>
#include <vector>

#include "core/discrepancy/effect_fit.h"

namespace fatmc {

enum class Verdict { none, named, effect_class, unknown };
std::string_view name(Verdict verdict);

struct DiagnosisOptions {
  int most_effects = 2;  ///< at once; what more there is, the next round finds with the patched model
  int rivals = 3;        ///< candidates that are fitted in a forward step, at most
  int fit_flights = 2;   ///< behind a step of a fit; intervals and verdicts rest on FittedLaw::kFlights
  std::vector<std::string> excluded;  ///< ids of candidates that are left out of this one search
  std::vector<Effect>
      nuisances;  ///< start values of what is estimated beside and never named, turbulence for instance
};

/// |z|^2 per degree of freedom.
struct Gap {
  double before = 0.0, after = 0.0, floor = 0.0;
};

struct ParameterEstimate {
  std::string name, unit;
  double value = 0.0, low = 0.0, high = 0.0;  ///< 95 % interval
};

struct FoundEffect {
  Effect effect;
  std::vector<ParameterEstimate> parameters;
  double gain = 0.0;  ///< in |z|^2, over the fit without it
};

/// Output of a filter for a moment that grows faster than the motion (moment_filters.h), on the first record, and its mean where the
/// model is right.
struct MomentOutput {
  std::string moment;
  double value = 0.0, mean = 0.0;
};

/// What the decision rests on.
struct Evidence {
  double scan = 0.0, energy = 0.0, local = 0.0;                 ///< of the discrepancy
  double scan_left = 0.0, energy_left = 0.0, local_left = 0.0;  ///< of what the effects leave
  std::string leading;                                          ///< effect with the largest GLR
  double level = 0.0,
         level_limit = 0.0;  ///< score of level_probe.h with the answer's effects, and what it must exceed
  std::vector<MomentOutput> moments;
};

struct Diagnosis {
  Verdict verdict = Verdict::none;
  std::vector<FoundEffect> effects;  ///< unknown: a partial explanation, or none
  std::vector<Effect> environment;   ///< nuisances at their estimates
  std::vector<Effect> members;       ///< of the class, the best first, at their own fits
  std::string separate_by;           ///< experiment that would tell the members apart
  Gap training, holdout;
  bool holdout_lines = true;  ///< every fifth line was held back; false: whole records
  Evidence evidence;
  Eigen::VectorXd residual;  ///< of all rows
  std::vector<std::string> notes;
  [[nodiscard]] std::vector<Effect> effect_list() const;
};

constexpr double kNamingLevel = 0.01;    ///< alpha of 2 p ln(V/alpha)
constexpr double kResolution = 5e-4;     ///< of the discrepancy's excess energy
constexpr double kMaterialShare = 5e-4;  ///< of that energy: the least gain of a further effect
constexpr double kMaterialSize = 0.05;   ///< of the least moderate size
constexpr double kClassGain = 10.6;      ///< 2 ln of a likelihood ratio of 200

/// `holdout`: records that take no part in the fit, or null.
Diagnosis diagnose(const Comparison& comparison, const Comparison* holdout, const DiagnosisOptions& options);

}  // namespace fatmc
