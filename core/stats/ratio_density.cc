#include "core/stats/ratio_density.h"

#include <array>
#include <cmath>
#include <numbers>

#include "core/base/check.h"

namespace fatmc {

double ratio_density(std::complex<double> g, const RatioNoise& n) {
  const double a = n.output * n.output + std::norm(g) * n.input * n.input -
                   2.0 * n.output * n.input * (n.correlation * std::conj(g)).real();
  FATMC_CHECK(a > 0.0, "noise in y - g u");
  const std::complex<double> mean =
      1.0 + (g - 1.0) * (std::conj(n.correlation) * n.output - std::conj(g) * n.input) * n.input / a;
  const double variance = n.input * n.input * n.output * n.output * (1.0 - std::norm(n.correlation)) / a;
  return (variance + std::norm(mean)) * std::exp(-std::norm(g - 1.0) / a) / (std::numbers::pi * a);
}

double ratio_disc_probability(double radius, const RatioNoise& noise) {
  FATMC_CHECK(radius >= 0.0, "a radius");
  // Gauss-Legendre of five nodes on each of kRings rings.
  constexpr std::array<double, 5> kNode = {0.0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640,
                                           -0.9061798459386640};
  constexpr std::array<double, 5> kWeight = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665,
                                             0.2369268850561891, 0.2369268850561891};
  constexpr int kRings = 200, kAngles = 256;
  const double half = 0.5 * radius / kRings;
  double sum = 0.0;
  for (int ring = 0; ring < kRings; ++ring) {
    for (std::size_t i = 0; i < kNode.size(); ++i) {
      const double r = half * (2 * ring + 1 + kNode[i]);
      double circle = 0.0;
      for (int t = 0; t < kAngles; ++t) {
        circle += ratio_density(1.0 + std::polar(r, 2.0 * std::numbers::pi * (t + 0.5) / kAngles), noise);
      }
      sum += kWeight[i] * half * r * circle * 2.0 * std::numbers::pi / kAngles;
    }
  }
  return sum;
}

}  // namespace fatmc
