// Names of what a trial of the conditions study leaves in its row, shared by the trial that writes and the summary that
// reads.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace fatmc::conditions {

/// Elements that do not vanish in level flight: those within the longitudinal and within the lateral motion.
struct Element {
  int output, input;
  std::string_view key, label;
};
inline constexpr std::array<Element, 5> kElements = {{{0, 0, "p_xi", "p/ξ_c"},
                                                      {1, 1, "q_eta", "q/η_c"},
                                                      {2, 2, "r_zeta", "r/ζ_c"},
                                                      {2, 0, "r_xi", "r/ξ_c"},
                                                      {0, 2, "p_zeta", "p/ζ_c"}}};

/// Arrays of an element, an entry a line, named for instance "r_xi.error_re".
inline constexpr std::string_view kErrorReal = "error_re";  ///< Re((Ĝ − G0)/G0)
inline constexpr std::string_view kErrorImag = "error_im";
inline constexpr std::string_view kVariance = "variance";  ///< B_jj C_V,ii / |G0|²
inline constexpr std::string_view kFrequency = "frequency_hz";

/// Metrics.
inline constexpr std::string_view kRelativeError =
    "relative_error";  ///< of an element: rms over lines of |error|
inline constexpr std::string_view kInside95 = "share_inside_95";  ///< of all nine elements and lines, (5.13)
/// Median over the lines of the input SNR (5.10), an axis each.
inline constexpr std::array<std::string_view, 3> kMedianSnr = {
    "median_input_snr_db_xi_c", "median_input_snr_db_eta_c", "median_input_snr_db_zeta_c"};
/// Share of lines and inputs below three standard deviations of their noise (5.2.2).
inline constexpr std::string_view kOutliers = "share_of_outliers";

inline std::string name_of(const Element& element, std::string_view what) {
  return std::string(element.key) + "." + std::string(what);
}

}  // namespace fatmc::conditions
