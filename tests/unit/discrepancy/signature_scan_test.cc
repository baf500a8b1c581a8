#include "core/discrepancy/signature_scan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/discrepancy/comparison.h"
#include "core/random/random_stream.h"

namespace fatmc {
namespace {

Eigen::MatrixXd normals(Eigen::Index rows, Eigen::Index cols, std::string_view name) {
  RandomStream random({23, name_hash("scan test"), 0, 0}, name);
  Eigen::MatrixXd out(rows, cols);
  for (Eigen::Index j = 0; j < cols; ++j) {
    for (Eigen::Index i = 0; i < rows; ++i) out(i, j) = random.normal();
  }
  return out;
}

TEST(SignatureScan, ADiscrepancyAlongASignatureHasItsSquaredLengthAsRatio) {
  const Eigen::MatrixXd atoms = normals(50, 3, "atoms");
  const Eigen::VectorXd z = 0.7 * atoms.col(1);
  const std::vector<ScanHit> hits = scan_signatures(z, atoms, Eigen::MatrixXd(50, 0));
  EXPECT_NEAR(hits[1].amplitude, 0.7, 1e-12);
  EXPECT_NEAR(hits[1].glr, z.squaredNorm(), 1e-10);
  EXPECT_LT(hits[0].glr, hits[1].glr);
  EXPECT_LT(hits[2].glr, hits[1].glr);
}

TEST(SignatureScan, WhatIsFittedAlreadyNeitherCountsNorDisturbs) {
  const Eigen::MatrixXd atoms = normals(50, 2, "atoms"), fitted = normals(50, 2, "fitted");
  const Eigen::VectorXd z = 2.0 * atoms.col(0) + fitted * Eigen::Vector2d(100.0, -30.0);
  const std::vector<ScanHit> hits = scan_signatures(z, atoms, fitted);
  EXPECT_NEAR(hits[0].amplitude, 2.0, 1e-9);
  // A signature within what is fitted has nothing left to explain.
  const std::vector<ScanHit> within = scan_signatures(z, fitted.col(0), fitted);
  EXPECT_EQ(within[0].glr, 0.0);
}

TEST(SignatureScan, AmplitudesAreNeverNegative) {
  const Eigen::MatrixXd atom = normals(20, 1, "atoms");
  EXPECT_EQ(scan_signatures(-atom.col(0), atom, Eigen::MatrixXd(20, 0))[0].glr, 0.0);
}

// Where nothing is missing the ratio is half zero, half chi-square with one degree of freedom: P(GLR > 2.7055) = 5 %. 4000
// draws: standard error 0.34 %, four of them.
TEST(SignatureScan, NullLawIsHalfChiSquare) {
  constexpr int draws = 4000;
  const Eigen::MatrixXd atom = normals(40, 1, "atoms"), fitted = normals(40, 2, "fitted"),
                        z = normals(40, draws, "z");
  int beyond = 0;
  for (int i = 0; i < draws; ++i)
    beyond += scan_signatures(z.col(i), atom, fitted)[0].glr > 2.705543454 ? 1 : 0;
  EXPECT_NEAR(beyond / static_cast<double>(draws), 0.05, 4.0 * std::sqrt(0.05 * 0.95 / draws));
}

// Exponential draws: P(X > x) = exp(-x). From 1000 draws the quantile at 0.4 % has the standard error of the 5 % quantile,
// (0.95/0.05/1000)^(1/2) = 0.14, and of ln(12.5) times the mean excess of 50 draws, 2.53/50^(1/2) = 0.36; four of both.
TEST(TailQuantile, IsThatOfExponentialDraws) {
  RandomStream random({5, 0, 0, 0}, "tail");
  std::vector<double> draws;
  for (int i = 0; i < 1000; ++i) draws.push_back(-std::log(1.0 - random.uniform()));
  EXPECT_NEAR(tail_quantile(draws, 0.004), -std::log(0.004), 4.0 * std::hypot(0.14, 0.36));
  EXPECT_NEAR(tail_quantile({0.0, 1.0, 2.0, 3.0, 4.0}, 0.5), 2.0, 1e-12);
}

}  // namespace
}  // namespace fatmc
