// Names of what a coverage trial leaves in its row, shared by the trial that writes and the summary that
// reads. Elements stand line by line, inside a line output by output, inside an output input by input.
#pragma once

#include <string_view>

namespace fatmc::coverage {

inline constexpr std::string_view kErrorReal = "error_re";  ///< Re(Ĝ − G0), rad/s per normalised command
inline constexpr std::string_view kErrorImag = "error_im";  ///< Im(Ĝ − G0)
inline constexpr std::string_view kVariance = "variance";   ///< B_jj C_V,ii
inline constexpr std::string_view kBias = "bias";           ///< constant of the actual line offsets
inline constexpr std::string_view kBiasPrinted = "bias_printed_constant";
inline constexpr std::string_view kInputSnr =
    "input_snr_db";  ///< T (5.10), line by line, inside a line input by input

inline constexpr std::string_view kDegreesOfFreedom = "degrees_of_freedom";  // metrics
inline constexpr std::string_view kElements = "elements_per_line";
inline constexpr std::string_view kInputs = "inputs";
/// Share of the elements of all lines whose 95 % region holds G0: without bias (5.13), and max(0, |e| - b) in
/// it.
inline constexpr std::string_view kInside95 = "share_inside_95";
inline constexpr std::string_view kInsideExtended95 = "share_inside_95_extended";

}  // namespace fatmc::coverage
