// Whether a moment grows with more than the first power of the motion: matched filters on harmonics that are not excited.
//
// A quadratic or cubic moment looks like the linear derivative of its axis on the excited lines, since the part of x|x| or x^3 that
// is proportional to x is most of it (for a normal x of deviation s the linear part of x|x| is (8/pi)^(1/2) s x, of x^3 it is
// 3 s^2 x). The rest, 15 % of the power of x|x| and 40 % of that of x^3, is intermodulation and falls on harmonics of the period
// that are not excited, where the response of a linear model has nothing. Its power is spread so thinly that band powers do not
// show it; its form, however, is known: D(k), the DFT of [p q r] that a flight in calm air with exact gyros has more with the moment
// than without. With the noise's covariance S(k) between harmonics,
//
//   x = sum_k 2 Re(D(k)^H S(k)^-1 Y(k)) / (sum_k 2 D(k)^H S(k)^-1 D(k))^(1/2)
//
// over the quiet k has the largest mean over deviation of any linear function, and unit variance, were their noises independent (matched
// filter: Turin 1960, IRE Trans. Inf. Theory 6:311). Gusts smear lines over neighbours alike: more (7 for cubic yaw, 2 x 40 s), as the law sees.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/flight/effects/effect.h"

namespace fatmc {

class ModelSimulator;

/// Moments of higher order that are looked for, at the least moderate size: quadratic damping and cubic moments of each axis. They
/// are no candidates for a name: what they show is that a value depends on level.
const std::vector<Effect>& higher_moments();

struct MomentFilters {
  std::vector<Effect> moments;  ///< those of higher_moments() that the model survives and the rates show
  std::vector<int> bins;        ///< of the DFT of the whole record: harmonics that are not excited
  std::vector<Eigen::MatrixX3cd> weights;  ///< a moment each, bins x 3: x = sum Re(conj(weight) Y)

  /// Behind S: flights, with the bins about k that are no harmonics, up to a quarter of k away, since the spectra of gusts are steep
  /// where frequencies are low; these at least and at most.
  static constexpr int kNoiseFlights = 16, kLeastWidth = 4, kMostWidth = 15;
  static constexpr double kBandFactor = 4.0;  ///< filters reach up to this times the last excited line
};

/// The same model on the same reference, its features with the filters' outputs.
ModelSimulator with_moment_filters(const ModelSimulator& plain);

}  // namespace fatmc
