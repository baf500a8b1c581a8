// The four kinds of confidence region of a frequency response matrix, all in standard deviations of an element.
//
// | kind         | statement at level p                              | radius                                      |
// | univariate   | one element lies in its disc                      | sqrt F^-1(p; 2, 2q)                (2.207)  |
// | bonferroni   | all n_in n_out elements lie in theirs, at least p | sqrt F^-1(1 - (1-p)/n; 2, 2q)      (2.206)  |
// | simultaneous | every linear combination of the elements does     | sqrt T^2(p)              (2.205 corrected)  |
// | joint        | vec(G^-G)^H (B kron C_V)^-1 vec(G^-G) <= radius^2 | sqrt T^2(p)              (2.200 corrected)  |
//
// T^2(p): quantile of the complex Lawley-Hotelling trace (lawley_hotelling.h). Simultaneous discs are the
// shadows of the joint region: larger than Bonferroni's where only the elements are asked for. The joint
// region is the smallest.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace fatmc {

enum class RegionKind { univariate, bonferroni, simultaneous, joint };
inline constexpr std::array<RegionKind, 4> kRegionKinds = {RegionKind::univariate, RegionKind::bonferroni,
                                                           RegionKind::simultaneous, RegionKind::joint};
std::string_view name_of(RegionKind kind);

/// Radius at level p, 0 <= p <= 1 - 1e-9, of a matrix n_out x n_in with q complex degrees of freedom. None
/// for the last two kinds where q < n_out: C_V^ is singular then.
std::optional<double> region_radius(RegionKind kind, double p, int n_out, int n_in, double q);

}  // namespace fatmc
