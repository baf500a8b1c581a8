// Names of what a bias trial leaves in its row, shared by the trial that writes and the summary that reads. Two elements
// alone: the primary responses of pitch (q/η_c) and yaw (r/ζ_c). Arrays hold a value a line.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "core/ident/bias_reading.h"

namespace fatmc::bias {

inline constexpr std::string_view kFrequency = "frequency_hz";

struct Response {
  std::string_view key;   ///< in names of arrays
  std::string_view name;  ///< in figures
  int output, input;
  double bias_hz;               ///< where T states its bias estimate (4.2, 4.3)
  std::string_view bias_place;  ///< the mode there
};
inline constexpr std::array kResponses = {Response{"pitch", "q/eta_c", 1, 1, 0.08, "phugoid"},
                                          Response{"yaw", "r/zeta_c", 2, 2, 0.33, "Dutch roll"}};

/// Real and imaginary part of Ĝ/G0: the error response function (T 3.6, 3.7).
inline std::string ratio_re(const Response& response) { return std::string(response.key) + ".ratio_re"; }
inline std::string ratio_im(const Response& response) { return std::string(response.key) + ".ratio_im"; }

struct Reading {
  std::string_view key, name;
  BiasReading reading;
};
inline constexpr std::array kReadings = {
    Reading{"limit", "b of (2.145)", {.constant = BiasConstant::limit}},
    Reading{"offsets", "b of the actual offsets", {.constant = BiasConstant::exact_offsets}},
    Reading{"magnitude",
            "b of the magnitude",
            {.constant = BiasConstant::limit, .fit = BiasReading::Fit::magnitude}}};

/// Metric: b/|Ĝ| of a response at its `bias_hz`.
inline std::string relative_bias(const Response& response, const Reading& reading) {
  return std::string(response.key) + ".bias." + std::string(reading.key);
}

}  // namespace fatmc::bias
