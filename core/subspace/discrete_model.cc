#include "core/subspace/discrete_model.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <string>
#include <unsupported/Eigen/MatrixFunctions>
#include <vector>

#include "core/base/text.h"
#include "core/subspace/eigenvalues.h"

namespace fatmc {
namespace {

constexpr double kOnAxis = 1e-12, kDefective = 1e12;

Result<ContinuousModel> by_logarithm(const DiscreteModel& model, const Eigen::VectorXcd& eigenvalues,
                                     double sample_time_s) {
  const Eigen::Index n = model.a.rows(), n_u = model.b.cols();
  for (const std::complex<double>& z : eigenvalues) {
    const bool negative = z.real() <= 0.0 && std::abs(z.imag()) <= kOnAxis * std::max(1.0, std::abs(z));
    if (negative) {
      return fail("eigenvalue " + significant(z.real(), 4) +
                  " of A lies on the negative real axis and has no continuous counterpart under a zero-order "
                  "hold: lower the "
                  "order, or take the bilinear transform");
    }
  }
  Eigen::MatrixXd step = Eigen::MatrixXd::Zero(n + n_u, n + n_u);
  step.topLeftCorner(n, n) = model.a;
  step.topRightCorner(n, n_u) = model.b;
  step.bottomRightCorner(n_u, n_u).setIdentity();
  const Eigen::MatrixXd rate = Eigen::MatrixXd(step.log()) / sample_time_s;
  if (!rate.allFinite()) return fail("the matrix logarithm of A is not finite");
  return ContinuousModel{rate.topLeftCorner(n, n), rate.topRightCorner(n, n_u), model.c,
                         Eigen::MatrixXd::Zero(model.c.rows(), n_u)};
}

Result<ContinuousModel> by_bilinear(const DiscreteModel& model, const Eigen::VectorXcd& eigenvalues,
                                    double sample_time_s) {
  if ((eigenvalues.array() + 1.0).abs().minCoeff() <= kOnAxis) {
    return fail(
        "A has an eigenvalue at -1, the bilinear transform takes it to infinity: take the zero-order hold");
  }
  const Eigen::Index n = model.a.rows();
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(n, n);
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(identity + model.a);
  const double scale = 2.0 / std::sqrt(sample_time_s);
  const Eigen::MatrixXd lu_b = lu.solve(model.b);
  ContinuousModel out;
  out.a = lu.solve(model.a - identity) * (2.0 / sample_time_s);
  out.b = scale * lu_b;
  out.c = scale * Eigen::PartialPivLU<Eigen::MatrixXd>(identity + model.a.transpose())
                      .solve(Eigen::MatrixXd(model.c.transpose()))
                      .transpose();
  out.d = -model.c * lu_b;
  return out;
}

/// One index a real mode or pair (that with the positive imaginary part), ascending by |ln lambda|.
std::vector<Eigen::Index> mode_order(const Eigen::VectorXcd& values) {
  std::vector<Eigen::Index> order;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (values(i).imag() >= 0.0) order.push_back(i);
  }
  const auto speed = [&](Eigen::Index i) {
    return values(i) == std::complex<double>(0.0) ? std::numeric_limits<double>::infinity()
                                                  : std::abs(std::log(values(i)));
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index i, Eigen::Index j) { return speed(i) < speed(j); });
  return order;
}

}  // namespace

Result<ContinuousModel> continuous_model(const DiscreteModel& model, double sample_time_s,
                                         Continuation continuation) {
  const auto eigenvalues = eigenvalues_of(model.a);
  if (!eigenvalues) return fail("A is not finite");
  return continuation == Continuation::zoh ? by_logarithm(model, *eigenvalues, sample_time_s)
                                           : by_bilinear(model, *eigenvalues, sample_time_s);
}

Result<ModalModel> modal_model(const DiscreteModel& model) {
  const auto pairs = eigenpairs_of(model.a);
  if (!pairs) return fail("A is not finite");
  const Eigen::Index n = model.a.rows();
  Eigen::MatrixXd basis(n, n);
  ModalModel out;
  out.eigenvalues.resize(n);
  Eigen::Index column = 0;
  for (const Eigen::Index i : mode_order(pairs->values)) {
    const std::complex<double> value = pairs->values(i);
    basis.col(column) = pairs->vectors.col(i).real();
    out.eigenvalues(column++) = value;
    if (value.imag() > 0.0) {
      basis.col(column) = pairs->vectors.col(i).imag();
      out.eigenvalues(column++) = std::conj(value);
    }
  }
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(basis);
  if (column != n || !(lu.rcond() > 1.0 / kDefective))
    return fail("A has no basis of eigenvectors, there is no modal form");
  out.model = {lu.solve(model.a * basis), lu.solve(model.b), model.c * basis};
  return out;
}

Result<DiscreteModel> output_states_model(const DiscreteModel& model) {
  const Eigen::Index n = model.a.rows(), n_y = model.c.rows();
  if (n < n_y) {
    return fail("a model of order " + std::to_string(n) + " has too few states for " + std::to_string(n_y) +
                " outputs to be among them");
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(model.c.transpose());
  if (qr.rank() < n_y) return fail("C has not full rank: an output is a combination of the others");
  const Eigen::MatrixXd q = qr.householderQ();
  Eigen::MatrixXd basis(n, n);
  basis.topRows(n_y) = model.c;
  basis.bottomRows(n - n_y) = q.rightCols(n - n_y).transpose();
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(basis);
  const Eigen::MatrixXd inverse = lu.inverse();
  return DiscreteModel{basis * model.a * inverse, basis * model.b, model.c * inverse};
}

}  // namespace fatmc
