// Eigenvalues of real matrices: one place that instantiates the decomposition.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <optional>

namespace fatmc {

/// Nothing where the matrix is not finite or the iteration fails.
std::optional<Eigen::VectorXcd> eigenvalues_of(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

struct EigenPairs {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;  ///< columns, of norm 1
};
std::optional<EigenPairs> eigenpairs_of(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

/// Largest modulus of an eigenvalue.
std::optional<double> spectral_radius(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

/// Largest singular value.
double spectral_norm(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

/// Largest singular value of M^power, power >= 0, by repeated squaring of scaled matrices: neither overflows
/// nor underflows before the result does.
double spectral_norm_of_power(const Eigen::Ref<const Eigen::MatrixXd>& matrix, int power);

}  // namespace fatmc
