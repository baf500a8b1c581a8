// The second-order system on which T measures the interpolation error (2.5.4), and polynomials through its response.
//
//   G(j w) = w0^2 / (w0^2 - w^2 + 2 j zeta w0 w),   scaled to |G| = 1 at w_N = w0 sqrt(1 - zeta^2)
//
// Frequencies are x = (w - w_N)/(zeta w0): the approximate 3 dB range B_3dB = 2 zeta w0 is -1 <= x <= 1, and a window of
// width B_lpm reaches to x = +-B_lpm/B_3dB.
#pragma once

#include <complex>
#include <span>
#include <vector>

namespace fatmc {

class LightlyDamped {
 public:
  /// 0 < damping < 1.
  explicit LightlyDamped(double damping);
  [[nodiscard]] std::complex<double> response(double x) const;
  [[nodiscard]] double damping() const { return damping_; }

 private:
  double damping_, peak_;
};

enum class FittedPart { magnitude, imaginary };

/// `count` offsets from -width to width (x above), ends included: width = B_lpm / B_3dB.
std::vector<double> even_offsets(int count, double width);

/// Value at `centre` of the least-squares polynomial of `degree` through a real part of the response at centre + offsets.
double polynomial_at_centre(const LightlyDamped& system, double centre, std::span<const double> offsets,
                            int degree, FittedPart part);
/// The same polynomial at every offset.
std::vector<double> polynomial_values(const LightlyDamped& system, double centre,
                                      std::span<const double> offsets, int degree, FittedPart part,
                                      std::span<const double> at);

/// Error at `centre` of the complex polynomial, fit minus response: what the LPM makes of a response without noise.
std::complex<double> polynomial_error(const LightlyDamped& system, double centre,
                                      std::span<const double> offsets, int degree);

/// Fig. 2-17: seven lines over 0.8 B_3dB. The damping is not printed; the figure does not depend on it below 0.1.
inline constexpr double kFigure217Width = 0.8, kFigure217Damping = 0.05;

}  // namespace fatmc
