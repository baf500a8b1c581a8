// Whether what was named is one value: a linear derivative is the same at every level of the motion, a moment that grows faster is
// not, and looks like the derivative on the lines of one record.
//
// Nested extensions of an explanation by one parameter each, as directions a in white coordinates:
//   moments    the change by a quadratic or cubic moment of an axis (moment_filters.h), which shows on harmonics that are not
//              excited and, of several records at different levels, in their difference;
//   records    a parameter's column of the Jacobian on one record alone: the value there is another than on the others. It is known
//              of no form of the dependence.
// Of every direction the part a_J that neither the explanation's own parameters nor a small change of anything in the linear airframe
// can imitate is taken (J with the signatures of the linear effects), so that derivatives which are off by a few per cent do not pass
// for a dependence. Rao's score of the extension is then
//
//   s = a_J^T W^-1 r / |a_J|,   deviation and degrees of freedom by fitted_law.h,
//
// a Student variable where the explanation is right; the largest of the K scores is judged at level alpha/(2 K), from either side.
// Beside it kResolution of the discrepancy (diagnosis.h) is allowed, as it is for the residual.
#pragma once

#include <cmath>
#include <string>

#include "core/discrepancy/effect_selection.h"

namespace fatmc {

struct LevelProbe {
  /// alpha: for what was named, and where nothing was detected (beside the other thresholds, together 1 %).
  static constexpr double kNamed = 0.01, kNothing = 0.002;

  double score = 0.0;  ///< the largest against its limit, in deviations, signed
  double limit = 0.0;  ///< of |score|; 0: there was nothing to test
  Effect effect;       ///< the moment, or the effect whose value differs
  int record = -1;     ///< on which the value differs, counted from 0; -1: a moment
  [[nodiscard]] bool failed() const { return limit > 0.0 && std::abs(score) > limit; }
  /// One sentence; of a probe that failed.
  [[nodiscard]] std::string statement() const;
};

/// `allowed`: part of a squared score that is not held against the explanation.
LevelProbe probe_level(const Comparison& comparison, const Explanation& e, double alpha, double allowed);

}  // namespace fatmc
