// 3 × 3, the size of the flight loop: no allocation.
#include "core/robust/ssv_solver.h"

namespace fatmc::ssv {

template SsvBounds solve<3, 3>(
    const Eigen::Ref<const Eigen::MatrixXcd>&, const Eigen::Ref<const Eigen::MatrixXd>&, const SsvOptions&, SsvScaling*,
    WorstCase*);

}  // namespace fatmc::ssv
