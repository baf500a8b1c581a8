#include "core/ident/frm_estimate.h"

#include <cmath>

#include "core/base/check.h"

namespace fatmc {

void scale_response(FrmEstimate& estimate, double factor) {
  FATMC_CHECK(std::isfinite(factor) && factor > 0.0, "a ratio of speeds");
  for (int k = 0; k < estimate.line_count(); ++k) {
    estimate.G[k] *= factor;
    estimate.B[k] *= factor * factor;  // C_V stays the covariance of v = y - G u in the record's own units
    if (estimate.element_variance.count() > 0) estimate.element_variance[k] *= factor * factor;
  }
}

}  // namespace fatmc
