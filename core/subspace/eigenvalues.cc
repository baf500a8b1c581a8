#include "core/subspace/eigenvalues.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <cmath>

namespace fatmc {

std::optional<Eigen::VectorXcd> eigenvalues_of(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  if (!matrix.allFinite()) return std::nullopt;
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix, false);
  if (solver.info() != Eigen::Success) return std::nullopt;
  return solver.eigenvalues();
}

std::optional<EigenPairs> eigenpairs_of(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  if (!matrix.allFinite()) return std::nullopt;
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix, true);
  if (solver.info() != Eigen::Success) return std::nullopt;
  return EigenPairs{solver.eigenvalues(), solver.eigenvectors()};
}

std::optional<double> spectral_radius(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  const auto values = eigenvalues_of(matrix);
  if (!values) return std::nullopt;
  return values->cwiseAbs().maxCoeff();
}

double spectral_norm(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  return Eigen::JacobiSVD<Eigen::MatrixXd>(matrix).singularValues()(0);
}

double spectral_norm_of_power(const Eigen::Ref<const Eigen::MatrixXd>& matrix, int power) {
  const Eigen::Index n = matrix.rows();
  Eigen::MatrixXd result = Eigen::MatrixXd::Identity(n, n), square = matrix;
  double log_result = 0.0, log_square = 0.0;  // what has been scaled out
  const auto rescale = [](Eigen::MatrixXd& m, double& log_scale) {
    const double largest = m.cwiseAbs().maxCoeff();
    if (!(largest > 0.0)) return;
    m /= largest;
    log_scale += std::log(largest);
  };
  for (int rest = power; rest > 0; rest >>= 1) {
    if ((rest & 1) != 0) {
      result = (result * square).eval();
      log_result += log_square;
      rescale(result, log_result);
    }
    square = (square * square).eval();
    log_square *= 2.0;
    rescale(square, log_square);
  }
  return std::exp(log_result) * spectral_norm(result);
}

}  // namespace fatmc
