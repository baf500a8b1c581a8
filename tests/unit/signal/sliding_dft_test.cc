#include "core/signal/sliding_dft.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "core/random/random_stream.h"

namespace fatmc {
namespace {

constexpr int kWindow = 240;
const std::vector<int> kBins{0, 1, 7, 30, 119, 120};

/// Two channels of noise with an offset.
std::vector<std::vector<double>> samples(int count) {
  RandomStream stream({3, 1, 4, 1}, "sliding");
  std::vector<std::vector<double>> out;
  for (int i = 0; i < count; ++i) out.push_back({1.0 + stream.normal(), 100.0 * stream.normal()});
  return out;
}

/// Largest difference from RealDft over the window that ends with sample `last`, zeros before the first.
double error_after(const SlidingDft& sliding, const std::vector<std::vector<double>>& x, int last) {
  Eigen::MatrixXcd ours(static_cast<Eigen::Index>(kBins.size()), 2);
  sliding.spectrum(ours);
  double worst = 0.0;
  for (std::size_t c = 0; c < 2; ++c) {
    std::vector<double> window(kWindow, 0.0);
    for (int m = 0; m < kWindow; ++m) {
      const int n = last - kWindow + 1 + m;
      if (n >= 0) window[static_cast<std::size_t>(m)] = x[static_cast<std::size_t>(n)][c];
    }
    std::vector<std::complex<double>> bins(kWindow / 2 + 1);
    RealDft(kWindow).transform(window, bins);
    for (std::size_t k = 0; k < kBins.size(); ++k) {
      const std::complex<double> expected = bins[static_cast<std::size_t>(kBins[k])];
      worst = std::max(worst,
                       std::abs(ours(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(c)) - expected) /
                           (c == 0 ? 1.0 : 100.0));
    }
  }
  return worst;
}

TEST(SlidingDft, IsTheDftOfTheWindowWhereverItStands) {
  const auto x = samples(3 * kWindow + 17);
  SlidingDft sliding(kWindow, kBins, 2);
  for (int n = 0; n < static_cast<int>(x.size()); ++n) {
    sliding.push(x[static_cast<std::size_t>(n)]);
    if (n % 13 == 0 || n % kWindow >= kWindow - 2 || n % kWindow <= 1) {
      EXPECT_LT(error_after(sliding, x, n), 1e-11);
    }
  }
  EXPECT_TRUE(sliding.full());
}

TEST(SlidingDft, DoesNotDriftOverAThousandWindows) {
  const int count = 1000 * kWindow + 101;
  const auto x = samples(count);
  SlidingDft sliding(kWindow, kBins, 2);
  for (const auto& sample : x) sliding.push(sample);
  EXPECT_LT(error_after(sliding, x, count - 1), 1e-12);
}

TEST(SlidingDft, AnOutlierLeavesNoTraceAfterItHasLeftTheWindow) {
  auto x = samples(3 * kWindow);
  x[50][0] = 1e9;  // rounding of the sums at this size is 1e-7
  SlidingDft sliding(kWindow, kBins, 2);
  for (const auto& sample : x) sliding.push(sample);
  EXPECT_LT(error_after(sliding, x, static_cast<int>(x.size()) - 1), 1e-12);
}

TEST(SlidingDft, FillsRowsOfALargerSpectrum) {
  const auto x = samples(kWindow + 5);
  SlidingDft sliding(kWindow, kBins, 2);
  for (const auto& sample : x) sliding.push(sample);
  Eigen::MatrixXcd rows(static_cast<Eigen::Index>(kBins.size()), 2),
      all = Eigen::MatrixXcd::Constant(130, 2, {7.0, 0.0});
  sliding.spectrum(rows);
  sliding.spectrum_at_bins(all);
  EXPECT_EQ(all.row(30), rows.row(3));
  EXPECT_EQ(all.row(120), rows.row(5));
  EXPECT_EQ(all(31, 0), std::complex<double>(7.0, 0.0));
}

}  // namespace
}  // namespace fatmc
