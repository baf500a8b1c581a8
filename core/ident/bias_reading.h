// Readings of the interpolation bias estimate (T 2.142-2.145, C.4-C.14) where print leaves a choice.
//
//   b = |alpha (W / B_3dB)^E| |G|,   B_3dB = 2 sqrt((1 - 1/sqrt 2) |g0 / g2|)
//
// g0, g2: constant and quadratic term of the polynomial through the window. Open are
// - what the polynomial goes through: the complex estimate, as C.5 has it, or its magnitude, as "a reduction of magnitude"
//   above C.9 and the remark that g0 is positive below C.14 suggest. At a narrow peak the first gives 11.7, the second 2.9
//   times the error of the complex fit that the LPM is;
// - its variable: line numbers, as the matrix C.6 has them, or distances in frequency. They differ where lines are unevenly
//   spaced: by numbers, a change of spacing looks like curvature, and W = 2 n_E + 1 lines;
// - alpha: Table 2-3's limit at every line, W = (2 n_E + 1) times the mean spacing, as (2.145) has it, or the sum over the
//   actual offsets. At a border the window is one-sided and the sum about 2^E times larger and more.
// campaigns/stability compares them with what T prints.
#pragma once

#include "core/ident/interpolation_bias.h"

namespace fatmc {

struct BiasReading {
  enum class Fit { complex, magnitude };
  enum class Distance { frequency, line_number };
  BiasConstant constant = BiasConstant::exact_offsets;
  Fit fit = Fit::complex;
  Distance distance = Distance::frequency;
};

/// As interpolation_bias of interpolation_bias.h, which is the default reading to rounding.
MatrixStack<double> interpolation_bias(const LpmGrid& grid, const FrmEstimate& estimate,
                                       const BiasReading& reading);

}  // namespace fatmc
