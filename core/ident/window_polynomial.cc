#include "core/ident/window_polynomial.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace fatmc {
namespace {

/// Rows x (degree + 1): powers of x.
Eigen::MatrixXd vandermonde(std::span<const double> x, int degree) {
  Eigen::MatrixXd v(static_cast<Eigen::Index>(x.size()), degree + 1);
  for (Eigen::Index i = 0; i < v.rows(); ++i) {
    double power = 1.0;
    for (Eigen::Index g = 0; g < v.cols(); ++g, power *= x[static_cast<std::size_t>(i)]) v(i, g) = power;
  }
  return v;
}

}  // namespace

int bias_exponent(int order) { return order + (order % 2 == 0 ? 2 : 1); }

WindowPolynomial window_polynomial(std::span<const double> scaled, double scale, int order) {
  const int degree = std::max(2, order);  // a curvature needs degree 2
  const auto size = static_cast<Eigen::Index>(scaled.size());
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(size, size);
  const Eigen::MatrixXd rows = vandermonde(scaled, degree).householderQr().solve(identity);
  Eigen::RowVectorXd constant = rows.row(0);
  if (order < degree)  // what the LPM's own degree leaves over
    constant = vandermonde(scaled, order).householderQr().solve(identity).row(0);
  WindowPolynomial out;
  double moment = 0.0;
  for (Eigen::Index i = 0; i < size; ++i) {
    out.constant.push_back(rows(0, i));
    out.own_constant.push_back(constant(i));
    out.linear.push_back(rows(1, i) / scale);
    out.quadratic.push_back(rows(2, i) / (scale * scale));
    moment += constant(i) * std::pow(scaled[static_cast<std::size_t>(i)], bias_exponent(order));
  }
  out.moment = std::abs(moment) * std::pow(scale, bias_exponent(order));
  return out;
}

}  // namespace fatmc
