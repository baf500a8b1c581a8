#include "core/discrepancy/signature_scan.h"

#include <Eigen/QR>
#include <algorithm>

namespace fatmc {

std::vector<ScanHit> scan_signatures(const Eigen::Ref<const Eigen::VectorXd>& z,
                                     const Eigen::Ref<const Eigen::MatrixXd>& atoms,
                                     const Eigen::Ref<const Eigen::MatrixXd>& fitted) {
  Eigen::VectorXd products = atoms.transpose() * z;
  const Eigen::VectorXd whole = atoms.colwise().squaredNorm().transpose();
  Eigen::VectorXd left = whole;
  if (fitted.cols() > 0) {
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(fitted);
    const Eigen::MatrixXd basis =
        qr.householderQ() * Eigen::MatrixXd::Identity(fitted.rows(), static_cast<Eigen::Index>(qr.rank()));
    const Eigen::MatrixXd within = basis.transpose() * atoms;
    products -= within.transpose() * (basis.transpose() * z);
    left -= within.colwise().squaredNorm().transpose();
  }
  std::vector<ScanHit> out(static_cast<std::size_t>(atoms.cols()));
  constexpr double kLeast = 1e-12;  // of the squared length
  for (Eigen::Index a = 0; a < atoms.cols(); ++a) {
    ScanHit& hit = out[static_cast<std::size_t>(a)];
    hit.atom = static_cast<int>(a);
    if (!(left[a] > kLeast * whole[a]) || products[a] <= 0.0) continue;
    hit.amplitude = products[a] / left[a];
    hit.glr = products[a] * hit.amplitude;
  }
  return out;
}

}  // namespace fatmc
