// Least-squares polynomials through the lines of one window, as rows of weights.
#pragma once

#include <span>
#include <vector>

namespace fatmc {

/// For offsets d_i: constant_i, linear_i, quadratic_i are the weights with which values at d_i give the first coefficients
/// of the polynomial of degree max(R, 2) through them (appendix C.3); own_constant those of degree R itself.
struct WindowPolynomial {
  std::vector<double> constant, own_constant, linear, quadratic;
  double moment = 0.0;  ///< |sum_i s_i d_i^E|, s the own constant row, E = bias_exponent(R)
};

/// R + 2 for even R, R + 1 for odd R: the first power that a symmetric fit of degree R leaves in its constant term.
int bias_exponent(int order);

/// `scaled`: the offsets divided by `scale`, in [-1, 1], more than max(R, 2) different ones. Weights and moment are in
/// units of the offsets themselves.
WindowPolynomial window_polynomial(std::span<const double> scaled, double scale, int order);

}  // namespace fatmc
