// Poles and zeros of a state space.
#pragma once

#include <Eigen/Dense>
#include <complex>
#include <vector>

namespace fatmc {

/// Eigenvalues by magnitude, conjugate pairs together with the positive imaginary part first.
std::vector<std::complex<double>> sorted_eigenvalues(const Eigen::MatrixXd& a);

/// Zeros of c (s I - A)^-1 b + d, pole-zero pairs that cancel removed (modes that the input does not reach or
/// the output does not see), in the order of sorted_eigenvalues.
///
/// With relative degree k (the first k with m_k = c A^(k-1) b != 0) the zeros are the eigenvalues of
///   (I - b c A^(k-1) / m_k) A    on the null space of   [c; c A; ..; c A^(k-1)]
/// (zero dynamics: the motion with y = 0); with d != 0 those of A - b c / d. No infinite zeros are ever
/// computed.
std::vector<std::complex<double>> transmission_zeros(const Eigen::MatrixXd& a, const Eigen::VectorXd& b,
                                                     const Eigen::RowVectorXd& c, double d);

}  // namespace fatmc
