// Names of the metrics of a row, shared by trials and summary. Effects are numbers: places in effect_variants(). The row's detail
// says the same in words, with all values: "hidden ID:... ; answer named ID:...".
#pragma once

namespace fatmc::hidden_effect {

// The key.
inline constexpr const char* kHidden[] = {"hidden_1", "hidden_2"};  ///< -1: none
inline constexpr const char* kSize[] = {
    "size_1", "size_2"};  ///< largest distance from nominal, in least moderate sizes
inline constexpr const char* kTruth[] = {"truth_1", "truth_2"};  ///< first parameter

// The answer.
inline constexpr const char* kVerdict = "verdict";         ///< 0 none, 1 named, 2 class, 3 unknown
inline constexpr const char* kScan = "scan";               ///< largest likelihood ratio
inline constexpr const char* kNamedCount = "named_count";  ///< 0 where the verdict is none or unknown
inline constexpr const char* kNamed[] = {"named_1", "named_2", "named_3"};
inline constexpr const char* kClassSize = "class_size";  ///< 1 where there is no class

// Both. Effects of one declared class count as one. A class is a right name where all its members count as the hidden effect.
inline constexpr const char* kRight[] = {"right_1", "right_2"};
inline constexpr const char* kClassHolds =
    "class_holds";  ///< the first hidden effect is named or in the class
inline constexpr const char* kSpurious =
    "spurious_count";  ///< named ones that are neither hidden nor in error
inline constexpr const char* kFound[] = {"found_1",
                                         "found_2"};       ///< estimate of truth_1, truth_2, where named
inline constexpr const char* kLow[] = {"low_1", "low_2"};  ///< its 95 % interval
inline constexpr const char* kHigh[] = {"high_1", "high_2"};
/// Error over the distance from nominal, both on the natural scale; of a limit, which has none, the logarithm's error.
inline constexpr const char* kParameterError[] = {"parameter_error_1", "parameter_error_2"};
inline constexpr const char* kCovered[] = {"covered_1", "covered_2"};  ///< the interval holds the truth

// On records that the diagnosis never sees: whitened chi-square per feature without and with what was added to the model.
inline constexpr const char* kGapBefore = "gap_before";
inline constexpr const char* kGapAfter = "gap_after";
inline constexpr const char* kGapFloor = "gap_floor";
/// (after - floor) / (before - floor), not below 0; where before is beyond chance. 1 where nothing was named.
inline constexpr const char* kGapLeft = "gap_left";

}  // namespace fatmc::hidden_effect
