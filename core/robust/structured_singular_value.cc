#include "core/robust/structured_singular_value.h"

#include "core/base/check.h"
#include "core/robust/ssv_solver.h"

namespace fatmc {

std::string_view ssv_status_name(SsvStatus status) {
  switch (status) {
    case SsvStatus::met: return "met";
    case SsvStatus::gap: return "gap";
    case SsvStatus::not_converged: return "not_converged";
  }
  return "not_converged";
}

SsvBounds structured_singular_value(const Eigen::Ref<const Eigen::MatrixXcd>& x,
                                    const Eigen::Ref<const Eigen::MatrixXd>& radii, const SsvOptions& options,
                                    SsvScaling* scaling, WorstCase* worst) {
  FATMC_CHECK(radii.rows() == x.cols() && radii.cols() == x.rows(), "radii are n_out by n_in");
  FATMC_CHECK(x.allFinite() && radii.allFinite() && radii.minCoeff() >= 0.0, "finite loop, radii not negative");
  if (x.rows() == 3 && x.cols() == 3) return ssv::solve<3, 3>(x, radii, options, scaling, worst);
  return ssv::solve<Eigen::Dynamic, Eigen::Dynamic>(x, radii, options, scaling, worst);
}

}  // namespace fatmc
