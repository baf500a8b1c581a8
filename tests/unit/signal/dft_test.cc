#include "core/signal/dft.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <thread>
#include <vector>

#include "core/random/random_stream.h"

namespace fatmc {
namespace {

using Complex = std::complex<double>;

std::vector<double> noise(int n, std::uint64_t seed) {
  RandomStream stream({seed, 0, 0, 0}, "test");
  std::vector<double> x(static_cast<std::size_t>(n));
  for (double& v : x) v = stream.normal();
  return x;
}

TEST(RealDft, IsTheSumOfItsDefinition) {
  for (const int n : {2, 3, 4, 7, 10, 24, 125, 200}) {
    const std::vector<double> x = noise(n, 1);
    std::vector<Complex> bins(static_cast<std::size_t>(n / 2 + 1));
    RealDft(n).transform(x, bins);
    for (std::size_t m = 0; m < bins.size(); ++m) {
      Complex sum = 0.0;
      for (int i = 0; i < n; ++i) {
        sum += x[static_cast<std::size_t>(i)] *
               std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(m) * i / n);
      }
      EXPECT_LT(std::abs(bins[m] - sum / std::sqrt(n)), 1e-13 * n) << n << " " << m;
    }
  }
}

TEST(RealDft, GivesTheSameBinsWhenFewerAreAskedFor) {
  const std::vector<double> x = noise(1000, 2);
  std::vector<Complex> all(501), few(40);
  const RealDft dft(1000);
  dft.transform(x, all);
  dft.transform(x, few);
  EXPECT_TRUE(std::equal(few.begin(), few.end(), all.begin()));
}

TEST(RealDft, DoesNotCareHowTheInputIsAligned) {
  const std::vector<double> x = noise(1001, 3);
  std::vector<double> copy(x.begin() + 1, x.end());
  std::vector<Complex> a(501), b(501);
  RealDft(1000).transform(std::span(x).subspan(1), a);
  RealDft(1000).transform(copy, b);
  EXPECT_EQ(a, b);
}

TEST(RealDft, GivesWhiteNoiseItsVarianceAtEveryBin) {
  const std::vector<double> x = noise(200'000, 4);
  std::vector<Complex> bins(100'001);
  RealDft(200'000).transform(x, bins);
  double power = 0.0;
  for (std::size_t m = 1; m < 100'000; ++m) power += std::norm(bins[m]) / 99'999.0;
  EXPECT_NEAR(power, 1.0, 4.0 / std::sqrt(99'999.0));  // |X|^2 is exponential
}

TEST(RealDft, IsInvertedByItsInverse) {
  for (const int n : {5, 8, 1000}) {
    const std::vector<double> x = noise(n, 5);
    std::vector<Complex> bins(static_cast<std::size_t>(n / 2 + 1));
    std::vector<double> back(x.size());
    RealDft(n).transform(x, bins);
    inverse_real_dft(bins, back);
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(back[i], x[i], 1e-13);
  }
}

TEST(RealDft, GivesTheSameBitsInEveryThread) {
  const std::vector<double> x = noise(4096, 6);
  std::vector<std::vector<Complex>> results(4, std::vector<Complex>(2049));
  std::vector<std::thread> threads;
  for (auto& bins : results) threads.emplace_back([&] { RealDft(4096).transform(x, bins); });
  for (auto& thread : threads) thread.join();
  for (const auto& bins : results) EXPECT_EQ(bins, results.front());
}

}  // namespace
}  // namespace fatmc
