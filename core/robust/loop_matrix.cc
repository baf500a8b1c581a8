#include "core/robust/loop_matrix.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/robust/hermitian_spectrum.h"

namespace fatmc {
namespace {

template <int In, int Out>
double h_infinity(const Eigen::Ref<const Eigen::MatrixXcd>& x, const Eigen::Ref<const Eigen::MatrixXd>& radii,
                  double x_scale, double w_scale) {
  Eigen::Matrix<std::complex<double>, In, Out> n(x.rows(), x.cols());
  for (Eigen::Index j = 0; j < x.rows(); ++j) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < x.cols(); ++i) sum += (radii(i, j) / w_scale) * (radii(i, j) / w_scale);
    const double column = std::sqrt(sum);
    for (Eigen::Index i = 0; i < x.cols(); ++i) n(j, i) = column * (x(j, i) / x_scale);
  }
  const Eigen::Matrix<std::complex<double>, In, In> gram = n * n.adjoint();
  const double inputs = static_cast<double>(x.rows());
  return std::sqrt(inputs * std::max(0.0, hermitian_spectrum(gram).values(0))) * x_scale * w_scale;
}

}  // namespace

LoopMatrix loop_matrix(const Eigen::Ref<const Eigen::MatrixXcd>& plant,
                       const Eigen::Ref<const Eigen::MatrixXcd>& controller) {
  FATMC_CHECK(controller.rows() == plant.cols() && controller.cols() == plant.rows(), "controller is n_in by n_out");
  const Eigen::Index inputs = controller.rows();
  const Eigen::MatrixXcd product = controller * plant;
  const Eigen::MatrixXcd difference = Eigen::MatrixXcd::Identity(inputs, inputs) + product;
  LoopMatrix out;
  out.x = Eigen::MatrixXcd::Zero(inputs, controller.cols());
  if (!difference.allFinite()) return out;
  const Eigen::PartialPivLU<Eigen::MatrixXcd> lu(difference);
  // Against the size of what was added, so that a sum which cancels altogether is singular, too.
  const auto norm = [](const Eigen::MatrixXcd& m) { return m.cwiseAbs().colwise().sum().maxCoeff(); };
  out.reciprocal_condition = lu.rcond() * norm(difference) / (1.0 + norm(product));
  out.invertible = out.reciprocal_condition > 1e-14;  // NaN compares false
  if (out.invertible) out.x = lu.solve(controller);
  return out;
}

Eigen::MatrixXcd uncertainty_loop(const Eigen::Ref<const Eigen::MatrixXcd>& x,
                                  const Eigen::Ref<const Eigen::MatrixXd>& radii) {
  FATMC_CHECK(radii.rows() == x.cols() && radii.cols() == x.rows(), "radii are n_out by n_in");
  const Eigen::Index n_in = x.rows(), n_out = x.cols();
  Eigen::MatrixXcd m(n_in * n_out, n_in * n_out);
  for (Eigen::Index j = 0; j < n_in; ++j) {
    for (Eigen::Index i = 0; i < n_out; ++i) {
      for (Eigen::Index l = 0; l < n_in; ++l) {
        for (Eigen::Index k = 0; k < n_out; ++k) m(j * n_out + i, l * n_out + k) = -radii(i, j) * x(j, k);
      }
    }
  }
  return m;
}

double h_infinity_value(const Eigen::Ref<const Eigen::MatrixXcd>& x, const Eigen::Ref<const Eigen::MatrixXd>& radii) {
  FATMC_CHECK(radii.rows() == x.cols() && radii.cols() == x.rows(), "radii are n_out by n_in");
  FATMC_CHECK(x.allFinite() && radii.allFinite() && radii.minCoeff() >= 0.0, "finite loop, radii not negative");
  const double x_scale = x.cwiseAbs().maxCoeff(), w_scale = radii.maxCoeff();
  if (x_scale == 0.0 || w_scale == 0.0) return 0.0;
  if (x.rows() == 3 && x.cols() == 3) return h_infinity<3, 3>(x, radii, x_scale, w_scale);
  return h_infinity<Eigen::Dynamic, Eigen::Dynamic>(x, radii, x_scale, w_scale);
}

}  // namespace fatmc
