// Names of what a variance trial leaves in its row, shared by the trial that writes and the summary that reads. Elements
// stand line by line, inside a line output by output, inside an output input by input.
#pragma once

#include <string_view>
#include <vector>

namespace fatmc::variance {

inline constexpr std::string_view kFrequency = "frequency_hz";  ///< of the lines kept
inline constexpr std::string_view kReal = "g_re";               ///< Ĝ, rad/s per normalised command
inline constexpr std::string_view kImag = "g_im";
inline constexpr std::string_view kVariance = "variance";  ///< B_jj C_V,ii
inline constexpr int kElements = 9;

/// Lines that Fig. 4-3 shows, as indices: all within 0.15 Hz of either end of the band, between them every tenth. The
/// others would make rows six times as large.
std::vector<int> shown_lines(const std::vector<double>& frequency_hz);

}  // namespace fatmc::variance
