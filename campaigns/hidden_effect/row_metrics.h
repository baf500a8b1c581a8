// Names of the metrics of a row, shared by trials and summary. Effects are numbers: places in effect_variants().
#pragma once

namespace fatmc::hidden_effect {

inline constexpr const char* kHidden[] = {"hidden_1", "hidden_2"};  ///< -1: none
inline constexpr const char* kNamed[] = {"named_1", "named_2", "named_3"};
inline constexpr const char* kVerdict = "verdict";  ///< 0 none, 1 named, 2 class, 3 unknown
inline constexpr const char* kNamedCount = "named_count";
inline constexpr const char* kRightCount =
    "right_count";  ///< hidden effects among the named ones, declared classes included
inline constexpr const char* kSpurious =
    "spurious_count";                                    ///< named ones that are neither hidden nor in error
inline constexpr const char* kClassSize = "class_size";  ///< 1 where there is no class
inline constexpr const char* kClassHolds =
    "class_holds";  ///< the first hidden effect is named or in the class
inline constexpr const char* kParameterError =
    "parameter_error";                              ///< of the first strength, over its distance from nominal
inline constexpr const char* kCovered = "covered";  ///< the 95 % interval holds it
inline constexpr const char* kGapLeft = "gap_left";  ///< of the discrepancy energy on a record never seen
inline constexpr const char* kScan = "scan";

}  // namespace fatmc::hidden_effect
