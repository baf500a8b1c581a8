#include "core/flight/zeros.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace fatmc {
namespace {

using Complex = std::complex<double>;

/// Removes every zero that has a pole of its own within rounding.
std::vector<Complex> without_cancelling(std::vector<Complex> zeros, std::vector<Complex> poles) {
  // Eigenvalues of the two matrices agree to about 1e-10; true pairs of a model are farther apart than this.
  constexpr double tolerance = 1e-7;
  std::vector<Complex> out;
  for (const Complex& zero : zeros) {
    const auto near = std::min_element(poles.begin(), poles.end(), [&](const Complex& x, const Complex& y) {
      return std::abs(x - zero) < std::abs(y - zero);
    });
    if (near != poles.end() && std::abs(*near - zero) <= tolerance * std::max(1.0, std::abs(zero))) {
      poles.erase(near);
    } else {
      out.push_back(zero);
    }
  }
  return out;
}

}  // namespace

std::vector<Complex> sorted_eigenvalues(const Eigen::MatrixXd& a) {
  if (a.rows() == 0) return {};
  const Eigen::VectorXcd values = Eigen::EigenSolver<Eigen::MatrixXd>(a, false).eigenvalues();
  std::vector<Complex> out(values.begin(), values.end());
  std::stable_sort(out.begin(), out.end(), [](const Complex& x, const Complex& y) {
    const double dx = std::abs(x);
    const double dy = std::abs(y);
    if (std::abs(dx - dy) > 1e-9 * std::max(dx, dy)) return dx < dy;
    return x.imag() > y.imag();
  });
  return out;
}

std::vector<Complex> transmission_zeros(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                        const Eigen::RowVectorXd& c, double d) {
  const std::vector<Complex> poles = sorted_eigenvalues(a);
  if (d != 0.0) return without_cancelling(sorted_eigenvalues(a - b * c / d), poles);
  const Eigen::Index n = a.rows();
  Eigen::MatrixXd observed(0, n);
  Eigen::RowVectorXd row = c;
  for (Eigen::Index k = 1; k <= n; ++k) {
    observed.conservativeResize(k, n);
    observed.row(k - 1) = row / row.norm();
    const double markov = row * b;
    if (std::abs(markov) > 1e-12 * row.norm() * b.norm()) {
      const Eigen::MatrixXd zero_dynamics = a - b * (row * a) / markov;
      const Eigen::MatrixXd q = Eigen::MatrixXd(observed.transpose().householderQr().householderQ());
      const Eigen::MatrixXd basis = q.rightCols(n - k);
      return without_cancelling(sorted_eigenvalues(basis.transpose() * zero_dynamics * basis), poles);
    }
    row = row * a;
    if (row.norm() == 0.0) break;
  }
  return {};  // the transfer function is zero
}

}  // namespace fatmc
