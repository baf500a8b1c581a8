#include "core/stats/ratio_density.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "core/random/random_stream.h"

namespace fatmc {
namespace {

using Complex = std::complex<double>;

Complex circular(RandomStream& stream) {
  const double re = stream.normal();
  return Complex(re, stream.normal()) * std::numbers::sqrt2 * 0.5;
}

TEST(RatioDensity, IsGaussianWithoutInputNoise) {
  const RatioNoise noise{0.0, 0.2, 0.0};
  for (const Complex g : {Complex(1.0, 0.0), Complex(1.1, -0.3), Complex(0.7, 0.2)}) {
    EXPECT_NEAR(ratio_density(g, noise), std::exp(-std::norm(g - 1.0) / 0.04) / (std::numbers::pi * 0.04), 1e-12);
  }
  for (const double radius : {0.1, 0.3, 0.6}) {
    EXPECT_NEAR(ratio_disc_probability(radius, noise), 1.0 - std::exp(-radius * radius / 0.04), 1e-10);
  }
}

// Without output noise g = 1/(1 + u), so |g| < x is |1 + u| > 1/x; on the disc about 1 it is the density of u at 1/g - 1
// times |dg/du|^-2 = |g|^-4.
TEST(RatioDensity, IsThatOfAnInverseWithoutOutputNoise) {
  const double s = 0.4;
  for (const Complex g : {Complex(1.3, 0.0), Complex(0.8, -0.5), Complex(1.5, 0.7)}) {
    const double expected = std::exp(-std::norm(1.0 / g - 1.0) / (s * s)) / (std::numbers::pi * s * s) / std::pow(std::norm(g), 2);
    EXPECT_NEAR(ratio_density(g, {s, 0.0, 0.0}) / expected, 1.0, 1e-12);
  }
}

TEST(RatioDensity, HoldsTheRatiosThatItDescribes) {
  const RatioNoise noise{0.3, 0.4, Complex(-0.5, 0.4)};
  const double rest = std::sqrt(1.0 - std::norm(noise.correlation));
  constexpr int kRatios = 200'000;
  for (const double radius : {0.2, 0.5, 1.0, 2.0}) {
    RandomStream stream({41, 0, 0, 0}, "ratio");
    int inside = 0;
    for (int i = 0; i < kRatios; ++i) {
      const Complex u = circular(stream);
      const Complex y = noise.correlation * u + rest * circular(stream);
      const Complex g = (1.0 + noise.output * y) / (1.0 + noise.input * u);
      inside += std::abs(g - 1.0) < radius ? 1 : 0;
    }
    const double p = ratio_disc_probability(radius, noise);
    EXPECT_NEAR(inside / static_cast<double>(kRatios), p, 4.0 * std::sqrt(p * (1.0 - p) / kRatios)) << radius;
  }
}

}  // namespace
}  // namespace fatmc
