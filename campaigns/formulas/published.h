// Printed figures of Merkl (2018), Tables 2-1, 2-3, 2-4 and 3-1, with their number of digits. Line numbers are those of
// the source text (docs/notation.md).
#pragma once

#include <array>

#include "campaigns/formulas/printed.h"

namespace fatmc::formulas {

struct EtfeBiasRow {
  const char* name;
  Printed snr, decibel, uncorrelated, correlated;
};

struct OrderRow {
  int order;
  Printed alpha;
};

struct ModeRow {
  const char* name;
  Printed f0, damping, duration, spacing;
  bool real_pole;  ///< no damping is printed: 1
  bool bound;      ///< printed are "more than" and "less than"
};

// Lines 1258-1263. 0 dB is exact for every printing.
inline constexpr std::array<EtfeBiasRow, 5> kTable21 = {{
    {"1", {1.0, 1}, {0.0, 1}, {0.367, 3}, {0.736, 3}},
    {"2", {2.0, 1}, {6.02, 3}, {0.0183, 3}, {0.0366, 3}},
    {"3.1", {3.1, 2}, {10.0, 2}, {4.54e-5, 3}, {9.08e-5, 3}},
    {"5", {5.0, 1}, {13.9, 3}, {1.38e-11, 3}, {2.77e-11, 3}},
    {"10", {10.0, 2}, {20.0, 2}, {3.72e-44, 3}, {7.44e-44, 3}},
}};

// Lines 1973-1979.
inline constexpr std::array<OrderRow, 3> kTable23 = {
    {{2, {0.0857, 3}}, {4, {8.65e-6, 3}}, {6, {4.86e-9, 3}}}};

// Lines 2038-2043.
inline constexpr std::array<OrderRow, 3> kTable24 = {
    {{2, {0.0318, 3}}, {4, {6.67e-3, 3}}, {6, {1.46e-3, 3}}}};

// Lines 3303-3311.
inline constexpr std::array<ModeRow, 6> kTable31 = {{
    {"spiral", {0.68e-3, 2}, {1.0, 1}, {1e4, 1}, {1e-3, 1}, true, true},
    {"phugoid", {0.082, 2}, {0.077, 2}, {750.0, 2}, {1.33e-3, 3}, false, false},
    {"Dutch roll", {0.33, 2}, {0.18, 2}, {78.3, 3}, {0.013, 2}, false, false},
    {"short period", {0.48, 2}, {0.66, 2}, {14.8, 3}, {0.067, 2}, false, false},
    {"roll", {2.3, 2}, {1.0, 1}, {2.1, 2}, {0.48, 2}, true, false},
    {"actuators", {6.4, 2}, {0.9, 1}, {0.8, 1}, {1.2, 2}, false, false},
}};

// Lines 1932 (Fig. 2-17) and 3063 (Fig. 2-35).
inline constexpr Printed kPeakOfFit{0.989, 3}, kPeakOfFitDb{-0.097, 2}, kPeakErrorPercent{1.1, 2};
inline constexpr Printed kCoveredDamping{0.008, 1};

}  // namespace fatmc::formulas
