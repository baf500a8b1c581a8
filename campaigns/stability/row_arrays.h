// Names of what a stability trial leaves in its row, shared by the trial that writes and the summary that reads. Arrays
// hold a value a line; ratios are plain, not in dB.
#pragma once

#include <string>
#include <string_view>

#include "campaigns/stability/readings.h"

namespace fatmc::stability {

inline constexpr std::string_view kFrequency = "frequency_hz";
inline constexpr std::string_view kNominalHInfinity = "hinf_nominal";  ///< T (2.260)
inline constexpr std::string_view kNominalSsv = "ssv_nominal";
inline constexpr std::string_view kSmallestSnr = "snr_min_db";  ///< over the inputs, T (5.10)

inline constexpr std::string_view kBandHInfinity = "p_band_hinf";  // metrics, reading kMain, rule min
inline constexpr std::string_view kBandSsv = "p_band_ssv";
inline constexpr std::string_view kTotalHInfinity = "p_total_hinf";
inline constexpr std::string_view kTotalSsv = "p_total_ssv";
inline constexpr std::string_view kMinimumSnr = "minimum_snr_db";
inline constexpr std::string_view kLowSnrLines = "lines_below_snr";

enum class Criterion { h_infinity, ssv };
constexpr std::string_view criterion_key(Criterion c) { return c == Criterion::h_infinity ? "hinf" : "ssv"; }

/// H∞ or ssv of W = σ + b + intergrid |Ĝ| (T 2.252, 2.255).
inline std::string value_array(const Reading& reading, Criterion criterion) {
  return std::string(reading.key) + "." + std::string(criterion_key(criterion));
}
/// p of the line (T 2.271).
inline std::string confidence_array(const Reading& reading, Criterion criterion, Rule rule) {
  return std::string(reading.key) + ".p_" + std::string(criterion_key(criterion)) +
         (rule == Rule::bonferroni ? "_bonferroni" : "");
}

}  // namespace fatmc::stability
