// Law of the joint confidence region of a frequency response matrix: the complex Lawley-Hotelling trace.
//
// vec(G^ - G) is complex normal with covariance B kron C_V; B is known, C_V is estimated by C_V^ = W/q, W
// complex Wishart of dimension n_out with q degrees of freedom, independent of G^. Then
//
//   T^2 = vec(G^ - G)^H (B kron C_V^)^-1 vec(G^ - G) = q tr(W^-1 X X^H),   X n_out x n_in, iid unit complex
//   normal.
//
// T (2.200-2.202) takes the estimate of B kron C_V for a complex Wishart matrix of dimension n_out n_in,
// which would make T^2 a Hotelling T^2: n_1 q/n_2 F(n_1, n_2), n_1 = 2 n_in n_out, n_2 = 2q - n_1 + 2 (262 at
// 95 % for q = 10, 3 x 3). It is one of dimension n_out alone; the limit is 24.3 there. For one input both
// are the same law.
//
// Derivation. Of W^-1 X X^H, r = min(n_out, n_in) eigenvalues f are not zero; with s = max(n_out, n_in) and
// nu = q for n_out <= n_in, else q + n_in - n_out, their joint density is (James 1964)
//   c prod_i f_i^(s-r) (1 + f_i)^-(nu+s) prod_(i<j) (f_i - f_j)^2.
// Andreief's identity turns the Laplace transform of their sum into a determinant of one-dimensional
// integrals,
//   phi(z) = det_(i,j<r) int_0^inf p_i(f) p_j(f) f^(s-r) (1 + f)^-(nu+s) exp(-z f) df,
// p_i the polynomials that are orthonormal for that weight (so that phi(0) = 1 without any constant, and no
// Hankel matrix has to be inverted). The integrals are taken along
// f = x exp(j theta), x > 0, turned so far that exp(-z f) falls, by the trapezoidal rule in ln x; the distribution
// function follows by inversion along Talbot's contour (Weideman 2006: error of order 3.89^-N).
#pragma once

#include <complex>
#include <vector>

namespace fatmc {

class ComplexLawleyHotelling {
 public:
  struct Value {
    double value = 0.0;
    double error = 0.0;  ///< estimate: difference to a coarser contour, and rounding
  };

  /// q >= n_out >= 1, n_in >= 1 (checked); q need not be whole.
  ComplexLawleyHotelling(int n_out, int n_in, double q);

  /// P(T^2 <= t). Absolute error about 1e-12; tails below that are lost in it.
  [[nodiscard]] Value distribution(double t) const;
  /// T^2 that holds with probability p, 0 <= p <= 1 - 1e-9.
  [[nodiscard]] Value quantile(double p) const;

 private:
  [[nodiscard]] std::complex<double> laplace(std::complex<double> z) const;
  [[nodiscard]] double invert(double t, int node_count) const;
  void polynomials(std::complex<double> f, std::complex<double>* p) const;

  int r_;
  double a_, b_, q_;     ///< weight f^a (1 + f)^-b
  double first_, step_;  ///< ln x of the first node and their distance
  int count_;
  std::vector<double> alpha_, beta_;  ///< p_(i+1) = ((f - alpha_i) p_i - beta_(i-1) p_(i-1)) / beta_i
  double scale_ = 1.0;                ///< ln of the weight's integral
};

/// Limit that T (2.200-2.202) prints for T^2; needs q >= n_in n_out.
double printed_joint_limit(double p, int n_out, int n_in, double q);

}  // namespace fatmc
