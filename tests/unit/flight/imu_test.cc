#include "core/flight/imu.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/flight/aircraft.h"
#include "tests/unit/flight/fat.h"

namespace fatmc {
namespace {

using Vector = std::array<double, 3>;

/// Mean and variance of each axis over n samples at constant rates.
struct Moments {
  Vector mean{}, variance{};
};
Moments moments(const Gyro& gyro, const Vector& rates, int n, std::uint64_t seed) {
  RandomStream random(TrialSeed{seed, 0, 0, 0}, "imu");
  Vector sum{}, square{};
  const Vector reference = rates;
  for (int i = 0; i < n; ++i) {
    const Vector y = gyro.sample(rates, random);
    for (std::size_t a = 0; a < 3; ++a) {
      sum[a] += y[a] - reference[a];
      square[a] += (y[a] - reference[a]) * (y[a] - reference[a]);
    }
  }
  Moments out;
  for (std::size_t a = 0; a < 3; ++a) {
    out.mean[a] = sum[a] / n;
    out.variance[a] = square[a] / n - out.mean[a] * out.mean[a];
  }
  return out;
}

TEST(Imu, WhiteNoiseHasTheVarianceOfItsAngleRandomWalkInBothGrades) {
  constexpr int n = 100000;
  for (const char* grade : {"tactical", "industrial"}) {
    Imu imu = *fat_model().imu(grade);
    const double density = imu.noise_rad_sqrt_s;
    EXPECT_NEAR(density, (std::string(grade) == "tactical" ? 0.07 : 4.2) * kPi / 180.0 / 60.0, 1e-15);
    imu.range_rad_s = 0.0;  // no quantisation
    const Moments found = moments(Gyro(imu, 200.0), {0, 0, 0}, n, 21);
    const double wanted = density * density * 200.0;
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_NEAR(found.variance[a], wanted, 4.0 * wanted * std::sqrt(2.0 / n)) << grade;
      EXPECT_NEAR(found.mean[a], imu.bias_rad_s[a], 4.0 * std::sqrt(wanted / n)) << grade;
    }
  }
}

TEST(Imu, QuantisationAddsATwelfthOfTheSquaredQuantum) {
  Imu imu;
  imu.range_rad_s = 1.0;
  imu.bits = 10;
  const double quantum = 2.0 / 1024.0;
  EXPECT_DOUBLE_EQ(imu.quantum(), quantum);
  const Gyro gyro(imu, 200.0);
  RandomStream random(TrialSeed{22, 0, 0, 0}, "imu");
  RandomStream rates(TrialSeed{23, 0, 0, 0}, "rates");
  constexpr int n = 100000;
  double square = 0.0;
  for (int i = 0; i < n; ++i) {
    const double rate = 1.8 * rates.uniform() - 0.9;
    const double error = gyro.sample({rate, 0, 0}, random)[0] - rate;
    EXPECT_LE(std::abs(error), 0.5 * quantum * (1.0 + 1e-12));
    square += error * error;
  }
  // Uniform error: variance q^2/12, fourth moment q^4/80, hence a relative standard error of sqrt(0.8/n).
  const double wanted = quantum * quantum / 12.0;
  EXPECT_NEAR(square / n, wanted, 4.0 * wanted * std::sqrt(0.8 / n));
}

TEST(Imu, BiasScaleAndMisalignmentEnterAsInA1) {
  Imu imu;
  imu.bias_rad_s = {0.1, 0.2, 0.3};
  imu.scale_error = {0.01, 0.02, 0.03};
  imu.misalignment_rad = {0.001, 0.002, 0.003, 0.004, 0.005, 0.006};
  RandomStream random(TrialSeed{}, "imu");
  const Vector y = Gyro(imu, 200.0).sample({1.0, 2.0, 4.0}, random);
  EXPECT_DOUBLE_EQ(y[0], 0.1 + 1.01 * 1.0 + 0.001 * 2.0 + 0.002 * 4.0);
  EXPECT_DOUBLE_EQ(y[1], 0.2 + 0.003 * 1.0 + 1.02 * 2.0 + 0.004 * 4.0);
  EXPECT_DOUBLE_EQ(y[2], 0.3 + 0.005 * 1.0 + 0.006 * 2.0 + 1.03 * 4.0);
}

TEST(Imu, RatesBeyondTheRangeSaturate) {
  Imu imu = *fat_model().imu("tactical");
  RandomStream random(TrialSeed{}, "imu");
  const Vector y = Gyro(imu, 200.0).sample({50.0, -50.0, 0.0}, random);
  EXPECT_DOUBLE_EQ(y[0], 300.0 * kPi / 180.0);
  EXPECT_DOUBLE_EQ(y[1], -300.0 * kPi / 180.0);
}

}  // namespace
}  // namespace fatmc
