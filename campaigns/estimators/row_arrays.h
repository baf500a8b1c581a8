// Names of what a trial of the estimator study leaves in its row, shared by the trial that writes and the summary that
// reads. Each array has an entry a line; those of an estimator are named by its key, for instance "etfe.error_re".
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace fatmc::estimators {

struct Estimator {
  std::string_view key;    ///< in names of arrays and metrics
  std::string_view label;  ///< in tables and figures; T's name where T has the estimator
};

/// In the order of tables. T does not say whether chapter 3's fast LPM regresses on the input or on the reference.
inline constexpr std::array<Estimator, 4> kEstimators = {{
    {"etfe", "ETFE"},
    {"tlpm", "tLPM"},
    {"fast_lpm", "fastLPM"},
    {"fast_lpm_indirect", "fastLPM, indirect"},
}};

inline constexpr std::string_view kFrequency = "frequency_hz";
inline constexpr std::string_view kErrorReal = "error_re";  ///< Re((Ĝ − G0)/G0)
inline constexpr std::string_view kErrorImag = "error_im";
inline constexpr std::string_view kVariance = "variance";  ///< of Ĝ, over |G0|²

inline constexpr std::string_view kDegreesOfFreedom = "degrees_of_freedom";  // metrics
/// Share of lines whose 90 % region (F(2, 2q), the estimator's own variance) holds G0.
inline constexpr std::string_view kInside90 = "inside_90";
inline constexpr std::string_view kUnnoticed = "share_inside_muad";  ///< of lines
inline constexpr std::string_view kCost = "cost";                    ///< (3.9)
/// sqrt of the mean over lines of |(Ĝ − G0)/G0|²
inline constexpr std::string_view kRelativeError = "relative_error";

inline std::string name_of(const Estimator& estimator, std::string_view what) {
  return std::string(estimator.key) + "." + std::string(what);
}

}  // namespace fatmc::estimators
