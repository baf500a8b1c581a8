// Parameters drawn anew for every trial.
//
//   [[dispersion]]
//   path = "model.mass.mass_kg"         # any number of the spec (campaigns/base/spec_path.h)
//   name = "mass"                       # default: the last component of the path
//   law = "normal"                      # uniform, normal, truncated_normal, log_normal, multivariate_normal
//   apply = "set"                       # set: the draw is the value; add, scale: to or by the value that
//   stands there mean = 23.0 sd = 0.5
//
// Keys of the laws: uniform low, high; normal mean, sd; truncated_normal mean, sd (of the whole law), low,
// high; log_normal median, log_sd (standard deviation of the natural logarithm); multivariate_normal paths,
// names, mean, sd (lists) and correlation (a matrix). A draw depends on the trial and the dispersion's first
// name alone: its stream is "dispersion.NAME", so that adding or removing another one moves nothing.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "campaigns/base/tree.h"
#include "core/base/error.h"
#include "core/random/random_stream.h"

namespace fatmc {

struct Dispersion {
  enum class Law { uniform, normal, truncated_normal, log_normal, multivariate_normal };
  enum class Apply { set, add, scale };

  Law law = Law::normal;
  Apply apply = Apply::set;
  std::vector<std::string> names, paths;    ///< one each, unless multivariate
  double low = 0.0, high = 0.0;             ///< uniform, truncated
  std::vector<double> centre;               ///< mean; log-normal: median
  std::vector<double> spread;               ///< sd; log-normal: of the logarithm
  std::vector<std::vector<double>> factor;  ///< of the correlation (core/random/distributions.h)
  Tree place;                               ///< gives file and line to the values that are set

  /// One value a name.
  [[nodiscard]] std::vector<double> draw(const TrialSeed& trial) const;
  /// The middle of the law: what a spec is checked with before anything runs.
  [[nodiscard]] std::vector<double> typical() const;
};

/// The dispersions of a spec, none where it has none. Names and paths are unique.
Result<std::vector<Dispersion>> decode_dispersions(const Tree& spec);

/// Writes drawn values into a spec's tree. Fails where `add` or `scale` finds no number.
Status apply_draw(const Dispersion& dispersion, const std::vector<double>& values, Tree& tree);

/// Drawn values stand in a row as metrics of this prefix: "draw.mass".
inline constexpr std::string_view kDrawPrefix = "draw.";

}  // namespace fatmc
