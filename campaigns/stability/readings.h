// Readings of the systematic error b of an estimate that the study judges side by side, each with both rules of
// combining elements: T prints figures, but not which of them they come from.
#pragma once

#include <array>
#include <string_view>

#include "core/ident/bias_reading.h"

namespace fatmc::stability {

struct Reading {
  std::string_view key;   ///< in names of arrays
  std::string_view name;  ///< in tables
  bool bias = true;       ///< false: intergrid error alone
  BiasReading reading = {};
  std::string_view why;  ///< what separates its figures from those in print, by experiment (README.md)
};

inline constexpr std::array kReadings = {
    Reading{"limit",
            "b of (2.145)",
            true,
            {.constant = BiasConstant::limit},
            "no one noise level fits all: 1.7 times ours gives 0.990 and 0.964, but 36 lines with p = 0 in 50 runs"},
    Reading{"numbers",
            "b by line numbers (C.6)",
            true,
            {.constant = BiasConstant::limit, .distance = BiasReading::Distance::line_number},
            "no one noise level fits all: 1.7 times ours gives 0.990 and 0.964, but 36 lines with p = 0 in 50 runs"},
    Reading{"offsets",
            "b of the actual offsets",
            true,
            {.constant = BiasConstant::exact_offsets},
            "one-sided windows make b at the ends of the band 11 times that of (2.145)"},
    Reading{"magnitude",
            "b of the magnitude",
            true,
            {.constant = BiasConstant::limit, .fit = BiasReading::Fit::magnitude},
            "b is a quarter of that of (2.145); with twice the turbulence most figures would match"},
    Reading{"off", "without b", false, {}, "3 % and sigma are far below what the loop tolerates"}};

/// The reading of the figures, and of p_band in the rows.
inline constexpr const Reading& kMain = kReadings[0];

enum class Rule { min, bonferroni };
inline constexpr std::array kRules = {Rule::min, Rule::bonferroni};
constexpr std::string_view rule_name(Rule rule) { return rule == Rule::min ? "min" : "Bonferroni"; }

}  // namespace fatmc::stability
