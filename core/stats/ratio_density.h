// Exact distribution of a ratio of noisy spectra: the reference for the Gaussian approximation of the ETFE.
//
// g = (1 + y)/(1 + u) = G^/G0, u and y circular complex normal with variances s_u^2, s_y^2 and correlation rho =
// E[y conj u]/(s_u s_y). With a(g) = s_y^2 + |g|^2 s_u^2 - 2 s_y s_u Re(rho conj g), the variance of y - g u,
//
//   p(g) = 1/(pi a) (s_u^2 s_y^2 (1 - |rho|^2)/a + |m|^2) exp(-|g - 1|^2 / a),
//   m    = 1 + (g - 1)(conj(rho) s_y - conj(g) s_u) s_u / a                                        (T 2.165-2.167)
//
// m is the mean of 1 + u given y - g u = g - 1, and the first term its variance: p = E[|1 + u|^2 | ...] times the density
// of y - g u at g - 1.
#pragma once

#include <complex>

namespace fatmc {

struct RatioNoise {
  double input = 0.0;   ///< s_u: standard deviation of the input's noise over |U0|
  double output = 0.0;  ///< s_y
  std::complex<double> correlation;  ///< rho, |rho| <= 1
};

/// Density of g = G^/G0 over the complex plane. a(g) > 0 is required: some noise, and |rho| < 1 or g apart from
/// s_y rho / s_u.
double ratio_density(std::complex<double> g, const RatioNoise& noise);

/// P(|g - 1| <= radius), by Gauss-Legendre in the radius and the trapezoidal rule in the angle (spectrally accurate for a
/// smooth periodic integrand). Within 1e-8 of an independent computation for s_u <= 0.4, s_y >= 0.1 and radii up to five
/// times hypot(s_u, s_y); an output noise far below the input's makes the density too narrow for these nodes.
double ratio_disc_probability(double radius, const RatioNoise& noise);

}  // namespace fatmc
