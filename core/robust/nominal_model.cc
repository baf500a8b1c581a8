#include "core/robust/nominal_model.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace fatmc {

std::optional<StabilisedModel> stabilise(const SampledModel& model, double radius) {
  StabilisedModel out{model, 0, 0.0};
  const Eigen::Index n = model.a.rows();
  if (model.a.cols() != n || !model.a.allFinite()) return std::nullopt;
  if (n == 0) return out;
  const Eigen::RealSchur<Eigen::MatrixXd> schur(model.a);
  if (schur.info() != Eigen::Success) return std::nullopt;
  Eigen::MatrixXd t = schur.matrixT();
  for (Eigen::Index k = 0; k < n;) {
    // A block of two holds a complex pair: its determinant is |z|².
    const Eigen::Index size = k + 1 < n && t(k + 1, k) != 0.0 ? 2 : 1;
    const double modulus =
        size == 1 ? std::abs(t(k, k)) : std::sqrt(std::abs(t(k, k) * t(k + 1, k + 1) - t(k, k + 1) * t(k + 1, k)));
    out.largest_modulus = std::max(out.largest_modulus, modulus);
    if (modulus > radius) {
      t.block(k, k, size, size) *= radius / modulus;
      out.moved_poles += static_cast<int>(size);
    }
    k += size;
  }
  if (out.moved_poles > 0) out.model.a = schur.matrixU() * t * schur.matrixU().transpose();
  return out;
}

}  // namespace fatmc
