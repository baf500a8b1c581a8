// What theory says of the estimate over many runs: bands are 3 or 4 standard errors from the scatter between runs.
#include <gtest/gtest.h>

#include <array>

#include "core/ident/fast_lpm.h"
#include "core/signal/multisine.h"
#include "core/stats/confidence.h"
#include "core/stats/intervals.h"
#include "tests/unit/ident/synthetic_experiment.h"

namespace fatmc {
namespace {

using namespace test;

constexpr std::array<double, 4> kLevels = {0.75, 0.90, 0.95, 0.99};

struct CoverageCase {
  LpmGrid grid;
  Response g, g_ur;
  Eigen::MatrixXcd mixing;
  bool indirect = true;
  double scale = 1.0;  ///< of all spectra
};

/// Share of elements and lines inside the disc of each level, a run.
std::array<std::vector<double>, 4> coverage(const CoverageCase& c, int runs, std::uint64_t seed) {
  std::array<std::vector<double>, 4> shares;
  FastLpm lpm(c.grid, 3);
  for (int run = 0; run < runs; ++run) {
    RandomStream stream({seed, 0, 0, static_cast<std::uint64_t>(run)}, "coverage");
    const LineSpectra reference = random_phases(c.grid, stream);
    const Spectra z = closed_loop(c.grid, reference, c.g, c.g_ur, c.mixing, 3, stream);
    lpm.load_spectra(c.scale * z.outputs, c.scale * z.inputs);
    const FrmEstimate& estimate = c.indirect ? lpm.indirect(c.scale * reference) : lpm.direct();
    std::array<double, 4> inside{};
    for (int k = 0; k < estimate.line_count(); ++k) {
      const Eigen::MatrixXcd truth = c.g(c.grid.frequency_hz(k));
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          const double ratio = std::norm(estimate.G[k](i, j) - truth(i, j)) / estimate.variance(k, i, j);
          for (std::size_t l = 0; l < 4; ++l) inside[l] += ratio < f_quantile_2_2q(kLevels[l], estimate.q) ? 1.0 : 0.0;
        }
      }
    }
    for (std::size_t l = 0; l < 4; ++l) shares[l].push_back(inside[l] / (9.0 * estimate.line_count()));
  }
  return shares;
}

void expect_f_distribution(const CoverageCase& c, std::uint64_t seed) {
  const auto shares = coverage(c, 400, seed);
  for (std::size_t l = 0; l < 4; ++l) {
    const RunMean mean = mean_over_runs(shares[l]);
    EXPECT_NEAR(mean.mean, kLevels[l], 3.0 * mean.standard_error) << "level " << kLevels[l];
  }
}

CoverageCase open_loop_case(std::vector<int> lines) {
  RandomStream stream({100, 0, 0, 0}, "case");
  CoverageCase c{make_grid(std::move(lines), 3), random_polynomial(3, 3, 2, stream),
                 [](double) { return Eigen::MatrixXcd::Identity(3, 3); }, Eigen::MatrixXcd::Zero(6, 6), false};
  c.mixing.topLeftCorner(3, 3) = random_mixing(3, 0.05, stream);
  return c;
}

CoverageCase closed_loop_case(std::vector<int> lines) {
  RandomStream stream({101, 0, 0, 0}, "case");
  CoverageCase c{make_grid(std::move(lines), 3), random_polynomial(3, 3, 1, stream),
                 random_polynomial(3, 3, 1, stream), random_mixing(6, 0.005, stream)};
  return c;
}

TEST(LpmCoverage, FollowsFInOpenLoopOnADenseGrid) { expect_f_distribution(open_loop_case(consecutive_lines(57, 73)), 1); }

TEST(LpmCoverage, FollowsFInOpenLoopOnTable51) {
  expect_f_distribution(open_loop_case(lines_from_ranges(table_5_1_ranges(), 0.005).value()), 2);
}

TEST(LpmCoverage, FollowsFInClosedLoopWithCorrelatedNoise) {
  expect_f_distribution(closed_loop_case(consecutive_lines(57, 73)), 3);
}

TEST(LpmCoverage, DoesNotDependOnTheDftScale) {
  CoverageCase c = closed_loop_case(consecutive_lines(57, 40));
  const auto one = coverage(c, 20, 4);
  c.scale = std::sqrt(20'000.0);
  const auto other = coverage(c, 20, 4);
  for (std::size_t l = 0; l < 4; ++l) EXPECT_EQ(one[l], other[l]);
}

// Cov(G_ij, G_lm) = B_jm C_V,il for all pairs of elements: errors against what the estimate says of them, run by run,
// bands from the scatter between runs.
void expect_kronecker_covariance(const CoverageCase& c, bool one_reference, std::uint64_t seed) {
  const int runs = 3000, k = c.grid.line_count() / 2;
  RandomStream stream({seed, 0, 0, 0}, "covariance");
  const LineSpectra fixed = random_phases(c.grid, stream);
  FastLpm lpm(c.grid, 3);
  const Eigen::MatrixXcd truth = c.g(c.grid.frequency_hz(k));
  Eigen::MatrixXcd sum = Eigen::MatrixXcd::Zero(9, 9), pseudo = sum;
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(9, 9), pseudo_square = square;
  for (int run = 0; run < runs; ++run) {
    const LineSpectra reference = one_reference ? fixed : random_phases(c.grid, stream);
    const Spectra z = closed_loop(c.grid, reference, c.g, c.g_ur, c.mixing, 3, stream);
    lpm.load_spectra(z.outputs, z.inputs);
    const FrmEstimate& estimate = lpm.indirect(reference);
    const Eigen::MatrixXcd error = (estimate.G[k] - truth).reshaped(9, 1);
    Eigen::MatrixXcd difference = error * error.adjoint();
    for (int j = 0; j < 3; ++j) {
      for (int m = 0; m < 3; ++m) difference.block(3 * j, 3 * m, 3, 3) -= estimate.B[k](j, m) * estimate.C_V[k];
    }
    const Eigen::MatrixXcd circular = error * error.transpose();
    sum += difference / runs;
    square += difference.cwiseAbs2() / runs;
    pseudo += circular / runs;
    pseudo_square += circular.cwiseAbs2() / runs;
  }
  for (int a = 0; a < 9; ++a) {
    for (int b = 0; b < 9; ++b) {
      EXPECT_LT(std::abs(sum(a, b)), 4.0 * std::sqrt(square(a, b) / runs)) << a << ", " << b;
      EXPECT_LT(std::abs(pseudo(a, b)), 4.0 * std::sqrt(pseudo_square(a, b) / runs)) << "not circular: " << a << b;
    }
  }
}

TEST(LpmCovariance, IsBKroneckerCvForAllPairsOfElements) {
  expect_kronecker_covariance(closed_loop_case(consecutive_lines(57, 25)), false, 102);
}

// Removing the transient correlates the noise of neighbouring lines where their bins overlap. Over random phases that
// averages out (the test above); for one excitation it does not, unless the windows are apart, as for 12 periods.
TEST(LpmCovariance, IsBKroneckerCvForOneExcitationWhereTransientWindowsAreApart) {
  CoverageCase c = closed_loop_case(consecutive_lines(57, 25));
  c.grid = make_grid(consecutive_lines(57, 25), 3, {}, 12);
  expect_kronecker_covariance(c, true, 103);
}

TEST(LpmCovariance, EstimatesNoiseWithoutBias) {
  const CoverageCase c = closed_loop_case(consecutive_lines(57, 25));
  const Eigen::MatrixXcd truth = c.mixing * c.mixing.adjoint();
  FastLpm lpm(c.grid, 3);
  const int runs = 2000;
  for (const int k : {0, 12, 24}) {  // both borders and the middle
    Eigen::MatrixXcd noise = Eigen::MatrixXcd::Zero(6, 6);
    RandomStream stream({104, 0, 0, static_cast<std::uint64_t>(k)}, "noise");
    for (int run = 0; run < runs; ++run) {
      const LineSpectra reference = random_phases(c.grid, stream);
      const Spectra z = closed_loop(c.grid, reference, c.g, c.g_ur, c.mixing, 3, stream);
      lpm.load_spectra(z.outputs, z.inputs);
      const FrmEstimate& estimate = lpm.indirect(reference);
      noise += estimate.C_Z_noise[k] / runs;
    }
    for (int a = 0; a < 6; ++a) {
      for (int b = 0; b < 6; ++b) {
        const double scale = std::sqrt(truth(a, a).real() * truth(b, b).real() / runs);
        const double mu = c.grid.transient().mu_poly(k);
        EXPECT_LT(std::abs(noise(a, b) - mu * truth(a, b)), 4.0 * mu * scale / std::sqrt(7.0)) << k;
      }
    }
  }
}

}  // namespace
}  // namespace fatmc
