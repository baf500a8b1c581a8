// Any size.
#include "core/robust/ssv_solver.h"

namespace fatmc::ssv {

template SsvBounds solve<Eigen::Dynamic, Eigen::Dynamic>(
    const Eigen::Ref<const Eigen::MatrixXcd>&, const Eigen::Ref<const Eigen::MatrixXd>&, const SsvOptions&, SsvScaling*,
    WorstCase*);

}  // namespace fatmc::ssv
