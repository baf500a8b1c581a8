// What of a record is compared with what the model gives for the same reference: a vector of real features.
//
// Spectra are those of samples without the straight line from first to last.
//   line        Y(k) - T(k) of p, q, r, phi, theta at every excited line: real parts, then imaginary parts. Y is the DFT of
//               the whole record, T the transient through the neighbouring bins (2.101-2.110). With the reference given,
//               these are the sufficient statistics of the linear response; inputs follow from them through the controller.
//   dc          means of p, q, r, phi, theta, V, and of sin(phi) tan(phi): a turn of bank phi has q = (g/V) sin(phi) tan(phi)
//               and costs speed, which all lines then show
//   noise       log of the mean power of bins that are no harmonics of the period, a frequency band and channel
//   peak        log of largest over mean power of those bins: a tone shows here
//   distortion  log of the mean power of harmonics that are not excited: nonlinearity and noise
//   lattice     log of samples over distinct values of p, q, r: quantisation
//   controller  what the logged commands show of u = k (r - y) + o: gains over the stated ones, minus one; offsets; the turn
//               coordinator's gain
//   moment      outputs of filters for moments that grow faster than the motion (moment_filters.h); of the axis they act on
// Attitude and airspeed are left out where they were not measured.
#pragma once

#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/flight/effects/effect.h"
#include "core/ident/lpm_grid.h"

namespace fatmc {

enum class FeatureKind { line, dc, noise, peak, distortion, lattice, controller, moment };
std::string_view name(FeatureKind kind);

/// Features that belong together: their covariance is estimated as one full matrix.
struct FeatureBlock {
  FeatureKind kind = FeatureKind::line;
  int first = 0;  ///< of the feature vector
  std::vector<int>
      channels;   ///< index into FeatureLayout::channels; a line has 2 features a channel, others one
  int line = -1;  ///< index of the excited line, or -1
  double low_hz = 0.0, high_hz = 0.0;
  [[nodiscard]] int size() const {
    return static_cast<int>(channels.size()) * (kind == FeatureKind::line ? 2 : 1);
  }
};

struct FeatureLayout {
  PeriodicExperiment experiment;
  std::vector<std::string> channels;  ///< p, q, r and, where measured, phi, theta, V
  bool attitude = false, airspeed = false;
  bool controller = false;  ///< a loop whose gain is stated
  std::vector<FeatureBlock> blocks;
  int size = 0;

  /// Name of a block's channel, for reports.
  [[nodiscard]] std::string channel_name(int channel) const {
    return channel < static_cast<int>(channels.size()) ? channels[static_cast<std::size_t>(channel)]
                                                       : "turning";
  }
  /// Fails where the experiment leaves too few non-excited bins to tell noise from response.
  static Result<FeatureLayout> create(PeriodicExperiment experiment, bool attitude, bool airspeed,
                                      bool controller);
  /// The same with a block of features behind all others, one a moment (effects with a choice of axis).
  [[nodiscard]] FeatureLayout with_moments(const std::vector<Effect>& moments) const;
  /// Non-excited bins taken for the transient of a line, and the degree of their polynomial.
  static constexpr int kTransientBins = 10, kTransientOrder = 2;
};

}  // namespace fatmc
