// What a trial hides. This file and hidden_draw.cc know the simulator alone: nothing of core/discrepancy, neither its signatures
// nor its features, so that what is hidden and what searches share no more than the flight (tests/unit checks the includes).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/flight/effects/effect.h"
#include "core/random/random_stream.h"

namespace fatmc::hidden_effect {

/// How a cell draws.
struct Tier {
  int effects = 1;                  ///< hidden at once
  double size = 1.0;                ///< share of a moderate size
  std::vector<std::string> hidden;  ///< ids or names of what may be hidden
  std::array<double, 2>
      nominal_error{};  ///< smallest and largest relative error of each derivative in `uncertain`
  std::vector<std::string> uncertain;
  double turbulence_error = 0.0;  ///< of the logarithm of the turbulence's level
};

struct Drawn {
  std::vector<Effect> effects;  ///< the key
  std::vector<Effect> errors;   ///< of nominal values, and of the turbulence
};

/// Kinds with each choice that the words name.
std::vector<Effect> variants_named(const std::vector<std::string>& words);

/// Effects, sizes and signs from the stream; every variant is as likely as any other, two have different ids. Limits have no
/// size to be a share of: they come at a moderate size (limit_size.h makes them smaller).
Drawn draw(const Tier& tier, RandomStream& random);

}  // namespace fatmc::hidden_effect
