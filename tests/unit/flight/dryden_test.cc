#include "core/flight/dryden.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/flight/aircraft.h"

namespace fatmc {
namespace {

constexpr double kSigma = 1.5;
constexpr double kSpeed = 24.0;
constexpr double kSpan = 5.0;
constexpr double kTick = 0.02;

Dryden fat_air() { return Dryden(kSigma, kSpeed, kSpan, kTick); }

/// Integral of f over (0, infinity) by the midpoint rule on a logarithmic axis.
template <typename F>
double integral(const F& f) {
  constexpr int n = 200000;
  const double low = std::log(1e-7);
  const double high = std::log(1e6);
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    const double w = std::exp(low + (i + 0.5) * (high - low) / n);
    sum += f(w) * w;
  }
  return sum * (high - low) / n;
}

TEST(Dryden, TheTranslationalVariancesAreSigmaSquared) {
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(integral([&](double w) { return dryden_psd(channel, w, kSigma, kSpeed, kSpan); }),
                kSigma * kSigma, 1e-4 * kSigma * kSigma);
  }
}

TEST(Dryden, EveryStationaryVarianceIsTheIntegralOfTheFormula) {
  const auto covariance = fat_air().covariance();
  for (int channel = 0; channel < 6; ++channel) {
    const double wanted = integral([&](double w) { return dryden_psd(channel, w, kSigma, kSpeed, kSpan); });
    EXPECT_NEAR(covariance(channel, channel), wanted, 1e-4 * wanted) << channel;
  }
}

TEST(Dryden, ThePsdAtTheTicksIsTheFormulaWithItsAliases) {
  // Sampling folds the spectrum: S_T(w) = sum over k of S(w + 2 pi k/T), two-sided; one-sided alike for w <
  // pi/T.
  const Dryden air = fat_air();
  const double fold = 2.0 * kPi / kTick;
  for (int channel = 0; channel < 6; ++channel) {
    for (const double hertz : {0.002, 0.01, 0.05, 0.3, 1.0, 3.0, 10.0, 20.0}) {
      const double w = 2.0 * kPi * hertz;
      double wanted = dryden_psd(channel, w, kSigma, kSpeed, kSpan);
      constexpr int aliases = 20000;
      for (int k = 1; k <= aliases; ++k) {
        wanted += dryden_psd(channel, k * fold - w, kSigma, kSpeed, kSpan) +
                  dryden_psd(channel, k * fold + w, kSigma, kSpeed, kSpan);
      }
      // Aliases fall with 1/k^2: what is left out is a 1/20000 of what the first one adds.
      EXPECT_NEAR(air.sampled_psd(channel, w), wanted, 2e-5 * wanted) << channel << " at " << hertz;
    }
  }
}

TEST(Dryden, SimulatedGustsHaveThePeriodogramOfTheFormula) {
  // Bins of a length-N periodogram, |X|^2 T/(pi N) one-sided in w, are nearly independent exponentials: the
  // mean over M of them has the relative standard error 1/sqrt(M).
  const Dryden air = fat_air();
  constexpr int runs = 400;
  constexpr int length = 5000;
  const std::vector<double> hertz = {0.05, 0.2, 0.8, 2.5};  // whole bins of 0.01 Hz
  std::vector<std::array<double, 6>> power(hertz.size(), std::array<double, 6>{});
  std::vector<std::vector<std::complex<double>>> wave(hertz.size());
  for (std::size_t f = 0; f < hertz.size(); ++f) {
    for (int t = 0; t < length; ++t) {
      // Hann window against the leakage of the strong low frequencies; its power sum is 3/8 N.
      const double window = 0.5 - 0.5 * std::cos(2.0 * kPi * t / length);
      wave[f].push_back(window * std::polar(1.0, -2.0 * kPi * hertz[f] * kTick * t));
    }
  }
  for (int run = 0; run < runs; ++run) {
    RandomStream random(TrialSeed{11, 0, 0, static_cast<std::uint64_t>(run)}, "turbulence");
    auto x = air.start(random);
    std::vector<std::array<std::complex<double>, 6>> sum(hertz.size());
    for (int t = 0; t < length; ++t) {
      const auto g = air.gusts(x);
      air.advance(x, random);
      for (std::size_t f = 0; f < hertz.size(); ++f) {
        for (std::size_t c = 0; c < 6; ++c) sum[f][c] += g[c] * wave[f][static_cast<std::size_t>(t)];
      }
    }
    for (std::size_t f = 0; f < hertz.size(); ++f) {
      for (std::size_t c = 0; c < 6; ++c) {
        power[f][c] += std::norm(sum[f][c]) * kTick / (kPi * 0.375 * length) / runs;
      }
    }
  }
  for (std::size_t f = 0; f < hertz.size(); ++f) {
    for (int c = 0; c < 6; ++c) {
      // The window averages the PSD over the bin and its neighbours: (1, 4, 1)/6 in power.
      double wanted = 0.0;
      for (const int offset : {-1, 0, 1}) {
        const double w = 2.0 * kPi * (hertz[f] + 0.01 * offset);
        wanted += (offset == 0 ? 4.0 : 1.0) / 6.0 * air.sampled_psd(c, w);
      }
      EXPECT_NEAR(power[f][static_cast<std::size_t>(c)], wanted, 4.0 * wanted / std::sqrt(runs))
          << "channel " << c << " at " << hertz[f] << " Hz";
    }
  }
}

TEST(Dryden, StartAndLaterGustsHaveTheStationaryCovariance) {
  const Dryden air = fat_air();
  const auto wanted = air.covariance();
  constexpr int runs = 40000;
  Eigen::Matrix<double, 6, 6> start = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 6> later = start;
  for (int run = 0; run < runs; ++run) {
    RandomStream random(TrialSeed{12, 0, 0, static_cast<std::uint64_t>(run)}, "turbulence");
    auto x = air.start(random);
    const auto first = air.gusts(x);
    for (int t = 0; t < 50; ++t) air.advance(x, random);
    const auto second = air.gusts(x);
    const Eigen::Map<const Eigen::Matrix<double, 6, 1>> a(first.data());
    const Eigen::Map<const Eigen::Matrix<double, 6, 1>> b(second.data());
    start += a * a.transpose() / runs;
    later += b * b.transpose() / runs;
  }
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      // Variance of a product of normals: C_ii C_jj + C_ij^2.
      const double band = 4.0 * std::sqrt((wanted(i, i) * wanted(j, j) + wanted(i, j) * wanted(i, j)) / runs);
      EXPECT_NEAR(start(i, j), wanted(i, j), band);
      EXPECT_NEAR(later(i, j), wanted(i, j), band);
    }
  }
}

TEST(Dryden, TheAirTurnsAsItsVelocityChangesAlongThePath) {
  // Slow gusts (below the lags): q_g = -dw_g/dx, r_g = dv_g/dx. Their cross spectrum is that of a derivative,
  // so the covariance of q_g with w_g's change over a tick is negative, that of r_g with v_g's positive.
  const Dryden air = fat_air();
  RandomStream random(TrialSeed{13, 0, 0, 0}, "turbulence");
  auto x = air.start(random);
  double wq = 0.0;
  double vr = 0.0;
  for (int t = 0; t < 200000; ++t) {
    const auto before = air.gusts(x);
    for (int i = 0; i < 5; ++i) air.advance(x, random);
    const auto after = air.gusts(x);
    wq += (after[2] - before[2]) * after[4];
    vr += (after[1] - before[1]) * after[5];
  }
  EXPECT_LT(wq, 0.0);
  EXPECT_GT(vr, 0.0);
}

TEST(Dryden, NoTurbulenceIsExactlyCalm) {
  const Dryden air(0.0, kSpeed, kSpan, kTick);
  RandomStream random(TrialSeed{}, "turbulence");
  auto x = air.start(random);
  air.advance(x, random);
  for (const double g : air.gusts(x)) EXPECT_EQ(g, 0.0);
}

}  // namespace
}  // namespace fatmc
