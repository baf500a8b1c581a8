#include "core/discrepancy/record_features.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "core/discrepancy/null_law.h"
#include "core/random/random_stream.h"

namespace fatmc {
namespace {

constexpr int kPeriod = 500, kPeriods = 2;
constexpr double kRate = 50.0;

FeatureLayout layout() {
  std::vector<int> lines;
  for (int k = 4; k < 30; k += 2) lines.push_back(k);
  return *FeatureLayout::create({lines, kPeriod, kPeriods, kRate}, true, true, true);
}

/// A record that stands still but for what a test adds.
LoopRecord still() {
  const Eigen::Index n = kPeriod * kPeriods;
  LoopRecord out;
  out.reference.setZero(n, 3);
  out.input.setZero(n, 3);
  out.output.setZero(n, 3);
  out.attitude.setZero(n, 2);
  out.airspeed.setConstant(n, 1, 24.0);
  RandomStream random({3, 0, 0, 0}, "reference");
  for (Eigen::Index i = 0; i < n; ++i) {
    for (int c = 0; c < 3; ++c) out.reference(i, c) = random.normal();
  }
  return out;
}

const FeatureBlock& block(const FeatureLayout& l, FeatureKind kind, int line = -1) {
  for (const FeatureBlock& b : l.blocks) {
    if (b.kind == kind && b.line == line) return b;
  }
  ADD_FAILURE() << "no such block";
  return l.blocks.front();
}

TEST(RecordFeatures, ALineIsTheDftOfItsChannel) {
  const FeatureLayout l = layout();
  LoopRecord record = still();
  // q = 0.3 cos(2 pi k (n + 1/2) / N) at the third excited line, which ends as it begins: |Y| = 0.3 sqrt(N)/2, phase pi k/N.
  const int line = l.experiment.lines[2];
  for (Eigen::Index i = 0; i < record.output.rows(); ++i) {
    record.output(i, 1) =
        0.3 * std::cos(2.0 * std::numbers::pi * line * (static_cast<double>(i) + 0.5) / kPeriod);
  }
  const Eigen::VectorXd x = FeatureExtractor(l, Eigen::Vector3d::Constant(0.1)).extract(record);
  const FeatureBlock& b = block(l, FeatureKind::line, 2);
  const auto channels = static_cast<Eigen::Index>(b.channels.size());
  const double size = 0.3 * std::sqrt(kPeriod * kPeriods) / 2.0, phase = std::numbers::pi * line / kPeriod;
  EXPECT_NEAR(x[b.first + 1], size * std::cos(phase), 1e-10);
  EXPECT_NEAR(x[b.first + channels + 1], size * std::sin(phase), 1e-10);
  EXPECT_NEAR(x[b.first], 0.0, 1e-10);
}

TEST(RecordFeatures, ASlowDriftDoesNotReachTheNoiseAtHighFrequency) {
  const FeatureLayout l = layout();
  LoopRecord quiet = still();
  RandomStream random({6, 0, 0, 0}, "noise");
  for (Eigen::Index i = 0; i < quiet.output.rows(); ++i) quiet.output(i, 0) = 1e-4 * random.normal();
  LoopRecord drifting = quiet;
  drifting.output.col(0) += Eigen::VectorXd::LinSpaced(quiet.output.rows(), 0.0, 0.5);
  const FeatureExtractor extractor(l, Eigen::Vector3d::Constant(0.1));
  const Eigen::VectorXd x = extractor.extract(quiet), y = extractor.extract(drifting);
  for (const FeatureBlock& b : l.blocks) {
    if (b.kind != FeatureKind::noise || b.low_hz < 5.0) continue;
    EXPECT_NEAR(x[b.first], y[b.first], 1e-6);
  }
}

TEST(RecordFeatures, AConstantShowsInTheMeansAlone) {
  const FeatureLayout l = layout();
  LoopRecord record = still();
  record.output.col(2).setConstant(0.02);
  const Eigen::VectorXd x = FeatureExtractor(l, Eigen::Vector3d::Constant(0.1)).extract(record);
  const FeatureBlock& b = block(l, FeatureKind::dc);
  EXPECT_NEAR(x[b.first + 2], 0.02, 1e-14);
  EXPECT_NEAR(x[b.first + 5], 24.0, 1e-11);
  EXPECT_NEAR(x[block(l, FeatureKind::line, 0).first + 2], 0.0, 1e-10);
}

TEST(RecordFeatures, LoggedCommandsShowGainsOffsetsAndTheTurnCoordinator) {
  const FeatureLayout l = layout();
  LoopRecord record = still();
  RandomStream random({4, 0, 0, 0}, "bank");
  for (Eigen::Index i = 0; i < record.attitude.rows(); ++i) record.attitude(i, 0) = 0.2 * random.normal();
  const Eigen::Vector3d k(0.11, 0.1, 0.09);
  for (int c = 0; c < 3; ++c) record.input.col(c) = k[c] * (record.reference.col(c) - record.output.col(c));
  record.input.col(1).array() += 0.004;
  record.input.col(2).array() += 0.5 * 0.1 * 9.80665 / 24.0 * record.attitude.col(0).array().sin();
  const Eigen::VectorXd x = FeatureExtractor(l, Eigen::Vector3d::Constant(0.1)).extract(record);
  const FeatureBlock& b = block(l, FeatureKind::controller);
  EXPECT_NEAR(x[b.first], 0.1, 1e-10);
  EXPECT_NEAR(x[b.first + 1], 0.0, 1e-10);
  EXPECT_NEAR(x[b.first + 2], -0.1, 1e-10);
  EXPECT_NEAR(x[b.first + 4], 0.004, 1e-12);
  EXPECT_NEAR(x[b.first + 6], -0.5, 1e-10);
}

TEST(RecordFeatures, ALatticeShowsInTheRepeatedValues) {
  const FeatureLayout l = layout();
  LoopRecord record = still();
  for (Eigen::Index i = 0; i < record.output.rows(); ++i) record.output(i, 0) = static_cast<double>(i % 10);
  record.output.col(1).setLinSpaced(0.0, 1.0);
  const Eigen::VectorXd x = FeatureExtractor(l, Eigen::Vector3d::Constant(0.1)).extract(record);
  const FeatureBlock& b = block(l, FeatureKind::lattice);
  EXPECT_NEAR(x[b.first], std::log(100.0), 1e-12);
  EXPECT_EQ(x[b.first + 1], 0.0);
}

// Samples of known covariance: a line's complex channels mixed by a known matrix, all else white. Whitened by the law of one
// half, the other half has unit covariance to within sampling error.
TEST(NullLaw, WhitensWhatItHasNotSeen) {
  const FeatureLayout l = *FeatureLayout::create(
      {{4, 6, 8, 10, 12, 14, 16, 18, 20, 22}, kPeriod, kPeriods, kRate}, false, false, false);
  constexpr int flights = 4000;
  RandomStream random({8, 0, 0, 0}, "features");
  Eigen::MatrixXd x(flights, l.size);
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    for (Eigen::Index i = 0; i < flights; ++i) x(i, j) = random.normal();
  }
  const FeatureBlock& line = block(l, FeatureKind::line, 0);
  Eigen::Matrix3cd mix;
  using C = std::complex<double>;
  mix << C(2, 0), C(0, 0), C(0, 0), C(0.5, -1), C(1, 0), C(0, 0), C(0, 0.7), C(-0.3, 0.2), C(0.1, 0);
  for (Eigen::Index i = 0; i < flights; ++i) {
    Eigen::Vector3cd z;
    for (int c = 0; c < 3; ++c) z[c] = {x(i, line.first + c), x(i, line.first + 3 + c)};
    z = mix * z;
    for (int c = 0; c < 3; ++c) {
      x(i, line.first + c) = z[c].real() + 5.0;
      x(i, line.first + 3 + c) = z[c].imag();
    }
  }
  const NullLaw law = NullLaw::fit(l, x.topRows(flights / 2));
  EXPECT_NEAR(law.mean[line.first], 5.0, 4.0 * 2.0 / std::sqrt(flights / 2.0));
  const Eigen::MatrixXd rest = x.bottomRows(flights / 2);
  const Eigen::MatrixXd z = law.whiten(l, (rest.rowwise() - law.mean.transpose()).transpose());
  const Eigen::MatrixXd lines = z.middleRows(line.first, 6);
  const Eigen::MatrixXd covariance = lines * lines.transpose() / (flights / 2.0);
  // An element of the sample covariance has the error (2/N)^(1/2); twice that for the law's own, five of them for 36.
  EXPECT_LT((covariance - Eigen::MatrixXd::Identity(6, 6)).cwiseAbs().maxCoeff(),
            5.0 * 2.0 * std::sqrt(2.0 / (flights / 2.0)));
}

TEST(RecordFeatures, AMomentIsTheFilteredSpectrumOfHarmonicsThatAreNotExcited) {
  const FeatureLayout plain = layout();
  const int quiet = plain.experiment.lines[3] + 1;
  auto filters = std::make_shared<MomentFilters>();
  filters->moments = {*parse_effect("quadratic_damping:axis=pitch,ratio=0.2")};
  filters->bins = {kPeriods * quiet};
  filters->weights = {Eigen::MatrixX3cd::Zero(1, 3)};
  filters->weights[0](0, 1) = {0.4, -0.3};
  const FeatureExtractor extractor =
      FeatureExtractor(plain, Eigen::Vector3d::Constant(0.1)).with(std::move(filters));
  const FeatureBlock& b = block(extractor.layout(), FeatureKind::moment);
  EXPECT_EQ(b.channels, (std::vector<int>{1})) << "of pitch";
  EXPECT_EQ(b.first + b.size(), extractor.layout().size);
  // q = 0.3 cos(2 pi k (n + 1/2) / N): Y = 0.3 sqrt(N)/2 exp(j pi k/N); the filter gives Re(conj(w) Y).
  const auto output_at = [&](int harmonic) {
    LoopRecord record = still();
    for (Eigen::Index i = 0; i < record.output.rows(); ++i) {
      record.output(i, 1) =
          0.3 * std::cos(2.0 * std::numbers::pi * harmonic * (static_cast<double>(i) + 0.5) / kPeriod);
    }
    return extractor.extract(record)[b.first];
  };
  const double size = 0.3 * std::sqrt(kPeriod * kPeriods) / 2.0, phase = std::numbers::pi * quiet / kPeriod;
  EXPECT_NEAR(output_at(quiet), size * (0.4 * std::cos(phase) - 0.3 * std::sin(phase)), 1e-10);
  EXPECT_NEAR(output_at(quiet - 1), 0.0, 1e-10) << "an excited line is none of its business";
}

}  // namespace
}  // namespace fatmc
