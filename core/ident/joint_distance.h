// Distance of a response from an estimate in the metric of the joint confidence region.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/ident/frm_estimate.h"

namespace fatmc {

/// T^2 = vec(G^ - G)^H (B kron C_V)^-1 vec(G^ - G) = tr(E^H C_V^-1 E B^-T), E = G^ - G, at line k. It follows
/// the complex Lawley-Hotelling law of core/stats/lawley_hotelling.h with q of the estimate where G is the
/// true response; for a direct or an indirect estimate alike, C_V being taken at G^ for G. None where the
/// line has no estimate, where its variances do not factor (element_variance) or where C_V or B is singular
/// (q < n_out, no noise).
std::optional<double> joint_distance(const FrmEstimate& estimate, int k,
                                     const Eigen::Ref<const Eigen::MatrixXcd>& response);

}  // namespace fatmc
