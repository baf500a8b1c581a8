#include "core/robust/structured_singular_value.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <numbers>

#include "core/robust/loop_matrix.h"
#include "tests/unit/robust/random_plant.h"

namespace fatmc {
namespace {

using test::random_feedback_loop;
using test::random_loop;
using test::UncertainLoop;

RandomStream stream_of(std::uint64_t repetition) { return RandomStream({3, 0, 0, repetition}, "plant"); }

SsvBounds bounds(const UncertainLoop& loop) { return structured_singular_value(loop.x, loop.radii); }

double largest_singular_value(const Eigen::MatrixXcd& m) {
  return Eigen::JacobiSVD<Eigen::MatrixXcd>(m).singularValues()(0);
}

double spectral_radius(const Eigen::MatrixXcd& m) {
  return Eigen::ComplexEigenSolver<Eigen::MatrixXcd>(m, false).eigenvalues().cwiseAbs().maxCoeff();
}

TEST(StructuredSingularValue, IsModulusTimesRadiusForOneByOne) {
  const Eigen::MatrixXcd x = Eigen::MatrixXcd::Constant(1, 1, {3.0, -4.0});
  const SsvBounds out = structured_singular_value(x, Eigen::MatrixXd::Constant(1, 1, 0.7));
  EXPECT_NEAR(out.upper, 3.5, 1e-15);
  EXPECT_NEAR(out.lower, 3.5, 1e-15);
  EXPECT_TRUE(out.certified());
}

TEST(StructuredSingularValue, IsTheLargestLoopForADiagonalPlant) {
  Eigen::MatrixXcd x = Eigen::MatrixXcd::Zero(3, 3);
  x.diagonal() << std::complex<double>(1.0, 1.0), 0.5, std::complex<double>(0.0, -2.0);
  Eigen::MatrixXd radii = Eigen::MatrixXd::Constant(3, 3, 0.0);
  radii.diagonal() << 0.3, 2.0, 0.4;
  const SsvBounds out = structured_singular_value(x, radii);
  EXPECT_NEAR(out.upper, 1.0, 1e-12);  // 0.5 × 2
  EXPECT_TRUE(out.certified());
}

TEST(StructuredSingularValue, IsASumOverElementsForARankOneLoop) {
  // X = f gᴴ: det(I + X Δ) = 1 + Σ conj(g_i) Δ_ij f_j, least stable when all terms align: ssv = Σ |g_i| w_ij |f_j|.
  RandomStream stream = stream_of(1);
  for (const auto& [n_in, n_out] : {std::pair(3, 3), {2, 3}, {3, 1}, {1, 4}, {5, 4}}) {
    const UncertainLoop f = random_loop(n_in, 1, stream), g = random_loop(n_out, 1, stream);
    const Eigen::MatrixXd radii = random_loop(n_in, n_out, stream).radii;
    const double expected = g.x.cwiseAbs().col(0).dot(radii * f.x.cwiseAbs().col(0));
    const SsvBounds out = structured_singular_value(f.x * g.x.adjoint(), radii);
    EXPECT_NEAR(out.upper / expected, 1.0, 1e-10) << n_in << " x " << n_out;
    EXPECT_TRUE(out.certified()) << n_in << " x " << n_out;
  }
}

TEST(StructuredSingularValue, IsThePerronRootForANonNegativeLoop) {
  // With X ≥ 0 no phase can beat Δ = W: ssv = ρ(X W).
  for (std::uint64_t k = 0; k < 20; ++k) {
    RandomStream stream = stream_of(100 + k);
    UncertainLoop loop = random_loop(3, 3, stream);
    loop.x = loop.x.cwiseAbs().cast<std::complex<double>>();
    const SsvBounds out = bounds(loop);
    EXPECT_NEAR(out.upper / spectral_radius(loop.x * loop.radii), 1.0, 1e-10);
    EXPECT_TRUE(out.certified());
  }
}

TEST(StructuredSingularValue, LowerNeverExceedsUpperNorUpperTheHInfinityValue) {
  for (std::uint64_t k = 0; k < 300; ++k) {
    RandomStream stream = stream_of(200 + k);
    const Eigen::Index n_in = 1 + static_cast<Eigen::Index>(k % 4), n_out = 1 + static_cast<Eigen::Index>(k / 4 % 4);
    const UncertainLoop loop = random_loop(n_in, n_out, stream);
    const SsvBounds out = bounds(loop);
    EXPECT_GT(out.lower, 0.0);
    EXPECT_LE(out.lower, out.upper);
    EXPECT_LE(out.upper, h_infinity_value(loop.x, loop.radii) * (1.0 + 1e-12));
    EXPECT_NE(out.status, SsvStatus::not_converged) << "plant " << k;
    EXPECT_LE(out.excess, 1e-8);
  }
}

TEST(StructuredSingularValue, BoundsMeetOnMostRandomLoops) {
  // Where they do not, the gap is real: a search over phases from 200 random starts a plant found nothing above the
  // lower bound. Shares seen: 95 % here, 98 % and more with wider radii.
  int met = 0;
  double worst = 0.0;
  for (std::uint64_t k = 0; k < 500; ++k) {
    RandomStream stream = stream_of(1000 + k);
    const SsvBounds out = bounds(random_loop(3, 3, stream));
    met += out.certified() ? 1 : 0;
    worst = std::max(worst, 1.0 - out.lower / out.upper);
  }
  EXPECT_GE(met, 460);
  EXPECT_LT(worst, 0.06);
}

TEST(StructuredSingularValue, DynamicSizesAgreeWithTheFixedOne) {
  // A zero fourth input and output change nothing, but take the general path.
  for (std::uint64_t k = 0; k < 60; ++k) {
    RandomStream stream = stream_of(2000 + k);
    const UncertainLoop loop = random_loop(3, 3, stream);
    UncertainLoop wide{Eigen::MatrixXcd::Zero(4, 4), Eigen::MatrixXd::Zero(4, 4)};
    wide.x.topLeftCorner(3, 3) = loop.x;
    wide.radii.topLeftCorner(3, 3) = loop.radii;
    const SsvBounds fixed = bounds(loop), general = bounds(wide);
    EXPECT_NEAR(general.upper / fixed.upper, 1.0, 1e-8);
    EXPECT_NEAR(general.lower / fixed.lower, 1.0, 1e-7);
    EXPECT_EQ(general.status, fixed.status);
  }
}

TEST(StructuredSingularValue, ScalesWithRadiiAndIsUnchangedByUnitsOfChannels) {
  for (std::uint64_t k = 0; k < 40; ++k) {
    RandomStream stream = stream_of(3000 + k);
    const UncertainLoop loop = random_loop(3, 3, stream);
    const SsvBounds out = bounds(loop);
    for (const double scale : {1e-150, 1e-9, 1e9, 1e150}) {
      EXPECT_NEAR(structured_singular_value(loop.x, scale * loop.radii).upper / (scale * out.upper), 1.0, 1e-8);
      EXPECT_NEAR(structured_singular_value(scale * loop.x, loop.radii).upper / (scale * out.upper), 1.0, 1e-8);
    }
    // Other units: inputs times f, outputs times g.
    const Eigen::VectorXd f{{1e-3, 1.0, 40.0}}, g{{2.0, 1e4, 0.1}};
    const Eigen::MatrixXcd x = f.asDiagonal() * loop.x * g.cwiseInverse().asDiagonal();
    const Eigen::MatrixXd radii = g.asDiagonal() * loop.radii * f.cwiseInverse().asDiagonal();
    const SsvBounds other = structured_singular_value(x, radii);
    EXPECT_NEAR(other.upper / out.upper, 1.0, 1e-8);
    EXPECT_NEAR(other.lower / out.lower, 1.0, 1e-7);
  }
}

TEST(StructuredSingularValue, GrowsWithEveryRadius) {
  for (std::uint64_t k = 0; k < 40; ++k) {
    RandomStream stream = stream_of(4000 + k);
    UncertainLoop loop = random_loop(3, 3, stream);
    const double before = bounds(loop).upper;
    loop.radii(static_cast<Eigen::Index>(k % 3), static_cast<Eigen::Index>(k / 3 % 3)) *= 1.5;
    EXPECT_GE(bounds(loop).upper, before * (1.0 - 1e-8));
  }
}

TEST(StructuredSingularValue, IsTheSameForTheTransposedLoop) {
  for (std::uint64_t k = 0; k < 20; ++k) {
    RandomStream stream = stream_of(5000 + k);
    const UncertainLoop loop = random_loop(2, 4, stream);
    const SsvBounds out = bounds(loop);
    const SsvBounds transposed = structured_singular_value(loop.x.transpose(), loop.radii.transpose());
    EXPECT_NEAR(transposed.upper / out.upper, 1.0, 1e-8);
  }
}

TEST(StructuredSingularValue, TheWorstCaseItNamesMakesTheLoopSingular) {
  for (std::uint64_t k = 0; k < 200; ++k) {
    RandomStream stream = stream_of(6000 + k);
    const Eigen::Index n_in = 1 + static_cast<Eigen::Index>(k % 3), n_out = k % 2 == 0 ? 3 : 2;
    const UncertainLoop loop = random_loop(n_in, n_out, stream);
    WorstCase worst;
    const SsvBounds out = structured_singular_value(loop.x, loop.radii, {}, nullptr, &worst);
    ASSERT_EQ(worst.delta.rows(), n_out);
    const Eigen::MatrixXcd size = Eigen::MatrixXcd::Identity(n_in, n_in) - loop.x * worst.delta;
    EXPECT_LT(std::abs(size.determinant()), 1e-10);
    const Eigen::MatrixXd allowed = loop.radii / out.lower;
    EXPECT_LT((worst.delta.cwiseAbs() - allowed).cwiseAbs().maxCoeff(), 1e-12 * allowed.maxCoeff());
    // The same of the whole M: det(I − M Δ) with M = −W S X T and Δ = −diag(vec δ).
    const Eigen::MatrixXcd m = uncertainty_loop(loop.x, loop.radii);
    Eigen::VectorXcd delta(m.rows());
    for (Eigen::Index j = 0; j < n_in; ++j) {
      for (Eigen::Index i = 0; i < n_out; ++i) delta(j * n_out + i) = -worst.delta(i, j) / loop.radii(i, j);
    }
    const Eigen::MatrixXcd whole = Eigen::MatrixXcd::Identity(m.rows(), m.rows()) - m * delta.asDiagonal();
    EXPECT_LT(std::abs(whole.determinant()), 1e-10);
    EXPECT_NEAR(delta.cwiseAbs().maxCoeff(), 1.0 / out.lower, 1e-12 / out.lower);
  }
}

TEST(StructuredSingularValue, RanksDeficientLoopsAndZeroRadiiAreExactlyTheSmallerProblem) {
  RandomStream stream = stream_of(7000);
  const UncertainLoop small = random_loop(2, 2, stream);
  const double expected = bounds(small).upper;
  // An input that nothing drives, with large radii behind it; an output that nothing feeds back.
  UncertainLoop loop = random_loop(3, 3, stream);
  loop.x.topLeftCorner(2, 2) = small.x;
  loop.x.row(2).setZero();
  loop.radii.topLeftCorner(2, 2) = small.radii;
  loop.radii.row(2).setZero();
  EXPECT_NEAR(bounds(loop).upper / expected, 1.0, 1e-8);
  // One direction only between two groups: no loop through it, whatever its size.
  UncertainLoop chain{Eigen::MatrixXcd::Zero(3, 3), Eigen::MatrixXd::Zero(3, 3)};
  chain.x.topLeftCorner(2, 2) = small.x;
  chain.x(2, 2) = 0.01;
  chain.x(2, 0) = 1e6;
  chain.radii.topLeftCorner(2, 2) = small.radii;
  chain.radii(2, 2) = 0.01;
  const SsvBounds out = bounds(chain);
  EXPECT_NEAR(out.upper / expected, 1.0, 1e-8);
}

TEST(StructuredSingularValue, IsZeroWhereNothingIsUncertainOrNothingIsFedBack) {
  RandomStream stream = stream_of(7001);
  const UncertainLoop loop = random_loop(3, 3, stream);
  EXPECT_EQ(structured_singular_value(loop.x, Eigen::MatrixXd::Zero(3, 3)).upper, 0.0);
  EXPECT_EQ(structured_singular_value(Eigen::MatrixXcd::Zero(3, 3), loop.radii).upper, 0.0);
  // A triangular path has no loop either.
  Eigen::MatrixXcd x = Eigen::MatrixXcd::Zero(2, 2);
  x(0, 1) = 5.0;
  Eigen::MatrixXd radii = Eigen::MatrixXd::Zero(2, 2);
  radii(0, 0) = radii(1, 1) = 1.0;
  const SsvBounds out = structured_singular_value(x, radii);
  EXPECT_EQ(out.upper, 0.0);
  EXPECT_TRUE(out.certified());
}

TEST(StructuredSingularValue, SurvivesRandomZerosAndExtremeRatios) {
  for (std::uint64_t k = 0; k < 400; ++k) {
    RandomStream stream = stream_of(8000 + k);
    UncertainLoop loop = random_loop(3, 3, stream, 4.0);
    for (Eigen::Index j = 0; j < 3; ++j) {
      for (Eigen::Index i = 0; i < 3; ++i) {
        if (stream.normal() > 0.7) loop.radii(i, j) = 0.0;
        if (stream.normal() > 0.7) loop.x(j, i) = 0.0;
        if (stream.normal() > 1.0) loop.radii(i, j) *= 1e-9;
      }
    }
    WorstCase worst;
    const SsvBounds out = structured_singular_value(loop.x, loop.radii, {}, nullptr, &worst);
    EXPECT_TRUE(std::isfinite(out.upper) && std::isfinite(out.lower)) << k;
    EXPECT_LE(out.lower, out.upper);
    EXPECT_NE(out.status, SsvStatus::not_converged) << "plant " << k;
    EXPECT_LE(out.upper, h_infinity_value(loop.x, loop.radii) * (1.0 + 1e-12));
    if (out.lower > 0.0) {
      const Eigen::MatrixXcd m = Eigen::MatrixXcd::Identity(3, 3) - loop.x * worst.delta;
      EXPECT_LT(m.jacobiSvd().singularValues()(2) / std::max(1.0, largest_singular_value(m)), 1e-9) << k;
    }
  }
}

TEST(StructuredSingularValue, AWarmStartEndsWhereAColdOneDoes) {
  RandomStream stream = stream_of(9000);
  const UncertainLoop first = random_feedback_loop(3, stream), last = random_feedback_loop(3, stream);
  SsvScaling scaling;
  int warm_iterations = 0, cold_iterations = 0;
  for (int k = 0; k <= 200; ++k) {
    const double f = k / 200.0;
    const Eigen::MatrixXcd x = (1.0 - f) * first.x + f * last.x;
    const Eigen::MatrixXd radii = (1.0 - f) * first.radii + f * last.radii;
    const SsvBounds cold = structured_singular_value(x, radii);
    const SsvBounds warm = structured_singular_value(x, radii, {}, &scaling);
    EXPECT_NEAR(warm.upper / cold.upper, 1.0, 1e-8);
    EXPECT_EQ(warm.status, cold.status);
    warm_iterations += warm.iterations;
    cold_iterations += cold.iterations;
  }
  EXPECT_LT(warm_iterations, cold_iterations);
}

TEST(HInfinityValue, IsTheNormOfTheWholeLoopMatrix) {
  for (std::uint64_t k = 0; k < 40; ++k) {
    RandomStream stream = stream_of(10000 + k);
    const UncertainLoop loop = random_loop(1 + static_cast<Eigen::Index>(k % 4), 3, stream);
    const double expected = largest_singular_value(uncertainty_loop(loop.x, loop.radii));
    EXPECT_NEAR(h_infinity_value(loop.x, loop.radii) / expected, 1.0, 1e-13);
  }
}

TEST(UncertaintyLoop, IsTheProductOfItsPrintedFactorsInTheRightOrder) {
  RandomStream stream = stream_of(11000);
  const UncertainLoop loop = random_loop(2, 3, stream);
  Eigen::MatrixXd s = Eigen::MatrixXd::Zero(6, 2), t = Eigen::MatrixXd::Zero(3, 6);
  for (Eigen::Index j = 0; j < 2; ++j) {
    for (Eigen::Index i = 0; i < 3; ++i) s(3 * j + i, j) = t(i, 3 * j + i) = 1.0;
  }
  EXPECT_TRUE((t * s).isOnes());  // T S is a matrix of ones (2.243)
  const Eigen::MatrixXcd expected = -(loop.radii.reshaped().asDiagonal() * s).cast<std::complex<double>>() * loop.x * t;
  EXPECT_LT((uncertainty_loop(loop.x, loop.radii) - expected).norm(), 1e-14);
}

TEST(LoopMatrix, SolvesTheLoopAndNamesASingularOne) {
  RandomStream stream = stream_of(12000);
  const Eigen::MatrixXcd g = random_loop(2, 3, stream).x.transpose(), k = random_loop(2, 3, stream).x;
  const LoopMatrix loop = loop_matrix(g, k);
  ASSERT_TRUE(loop.invertible);
  EXPECT_LT(((Eigen::MatrixXcd::Identity(2, 2) + k * g) * loop.x - k).norm(), 1e-13);
  // K = −G⁻¹ puts I + K G to zero.
  const Eigen::MatrixXcd square = random_loop(3, 3, stream).x;
  EXPECT_FALSE(loop_matrix(square, -square.inverse()).invertible);
}

}  // namespace
}  // namespace fatmc
