#include "core/random/random_stream.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fatmc {
namespace {

// Known answers: the vectors that Random123 publishes for philox4x64-10 (kat_vectors).
TEST(Philox, GivesThePublishedKnownAnswers) {
  using Block = std::array<std::uint64_t, 4>;
  EXPECT_EQ(philox_block({0, 0, 0, 0}, {0, 0}), (Block{0x16554d9eca36314cULL, 0xdb20fe9d672d0fdcULL,
                                                       0xd7e772cee186176bULL, 0x7e68b68aec7ba23bULL}));
  const std::uint64_t ones = ~0ULL;
  EXPECT_EQ(
      philox_block({ones, ones, ones, ones}, {ones, ones}),
      (Block{0x87b092c3013fe90bULL, 0x438c3c67be8d0224ULL, 0x9cc7d7c69cd777b6ULL, 0xa09caebf594f0ba0ULL}));
}

TEST(RandomStream, RepeatsItselfAndDiffersByEveryPartOfItsKey) {
  const TrialSeed trial{1, 2, 3, 4};
  RandomStream a(trial, "imu"), b(trial, "imu");
  for (int i = 0; i < 10; ++i) EXPECT_EQ(a(), b());
  const std::uint64_t first = RandomStream(trial, "imu")();
  EXPECT_NE(first, RandomStream(trial, "turbulence")());
  EXPECT_NE(first, RandomStream({9, 2, 3, 4}, "imu")());
  EXPECT_NE(first, RandomStream({1, 9, 3, 4}, "imu")());
  EXPECT_NE(first, RandomStream({1, 2, 9, 4}, "imu")());
  EXPECT_NE(first, RandomStream({1, 2, 3, 9}, "imu")());
}

TEST(RandomStream, NormalHasTheMomentsOfAStandardNormal) {
  RandomStream stream({7, 0, 0, 0}, "test");
  const int n = 1'000'000;
  double m1 = 0, m2 = 0, m4 = 0, tail = 0;
  for (int i = 0; i < n; ++i) {
    const double x = stream.normal();
    m1 += x;
    m2 += x * x;
    m4 += x * x * x * x;
    tail += std::abs(x) > 3.0 ? 1.0 : 0.0;
  }
  // Bands of 4 standard errors: var(x) = 1, var(x^2) = 2, var(x^4) = 96, tail probability 0.0026998.
  EXPECT_NEAR(m1 / n, 0.0, 4.0 / std::sqrt(n));
  EXPECT_NEAR(m2 / n, 1.0, 4.0 * std::sqrt(2.0 / n));
  EXPECT_NEAR(m4 / n, 3.0, 4.0 * std::sqrt(96.0 / n));
  EXPECT_NEAR(tail / n, 0.0026998, 4.0 * std::sqrt(0.0027 / n));
}

}  // namespace
}  // namespace fatmc
