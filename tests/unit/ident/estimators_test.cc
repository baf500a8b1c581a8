// Exact cases and refusals of the estimators beside the fast LPM.
#include "core/ident/estimators.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/ident/line_averages.h"
#include "core/ident/local_rational.h"
#include "tests/unit/ident/measured_system.h"
#include "tests/unit/ident/synthetic_experiment.h"

namespace fatmc {
namespace {

using namespace test;
using testing::HasSubstr;

RandomStream stream_of(std::uint64_t study) { return RandomStream({study, 0, 0, 0}, "estimators"); }

/// Static gains in steady state.
Measurement static_periodic(const Eigen::MatrixXd& gain, int periods,
                            const std::vector<std::vector<int>>& lines, std::vector<int> all,
                            RandomStream& stream) {
  Measurement m;
  m.experiment = {std::move(all), 256, periods, 50.0};
  m.inputs.resize(256 * periods, gain.cols());
  for (Eigen::Index j = 0; j < gain.cols(); ++j) {
    m.inputs.col(j) = multisine(256, periods, lines[static_cast<std::size_t>(j)], stream);
  }
  m.outputs = m.inputs * gain.transpose();
  return m;
}

Eigen::MatrixXd gain_of(int n_out, int n_in) {
  Eigen::MatrixXd gain(n_out, n_in);
  for (int i = 0; i < n_out; ++i) {
    for (int j = 0; j < n_in; ++j) gain(i, j) = 1.0 + i - 0.7 * j + 0.3 * i * j;
  }
  return gain;
}

double worst_error(const FrmEstimate& e, const Eigen::MatrixXd& gain) {
  double worst = 0.0;
  for (int k = 0; k < e.line_count(); ++k) worst = std::max(worst, (e.G[k] - gain).cwiseAbs().maxCoeff());
  return worst;
}

TEST(Etfe, IsExactInSteadyStateWithoutNoise) {
  RandomStream stream = stream_of(1);
  const Mode mode(0.08, 0.1);
  const std::vector<int> lines = {10, 14, 20, 27, 35};
  Measurement m;
  m.experiment = {lines, 256, 3, 1.0};
  const Eigen::VectorXd u = multisine(256, 20, lines, stream);
  m.inputs = u.tail(3 * 256);
  m.outputs = mode.simulate(u).tail(3 * 256);
  const auto estimate = estimate_response(EstimationMethod::etfe, {&m, 1}, {});
  ASSERT_TRUE(estimate) << estimate.error().text();
  for (int k = 0; k < 5; ++k) {
    EXPECT_LT(std::abs(estimate->frm.G[k](0, 0) - mode.response(lines[static_cast<std::size_t>(k)] / 256.0)),
              1e-12);
  }
}

TEST(TransientLpm, TakesTheStartFromRestOutOfTheEtfe) {
  RandomStream stream = stream_of(2);
  const Mode mode(0.08, 0.1);
  const std::vector<int> lines = {10, 14, 20, 27, 35};
  Measurement m;
  m.experiment = {lines, 256, 2, 1.0};
  m.inputs = multisine(256, 2, lines, stream);
  m.outputs = mode.simulate(m.inputs.col(0));
  const auto etfe = estimate_response(EstimationMethod::etfe, {&m, 1}, {});
  const auto tlpm = estimate_response(EstimationMethod::tlpm, {&m, 1}, {});
  ASSERT_TRUE(etfe && tlpm);
  double etfe_error = 0.0, tlpm_error = 0.0;
  for (int k = 0; k < 5; ++k) {
    const std::complex<double> truth = mode.response(lines[static_cast<std::size_t>(k)] / 256.0);
    etfe_error += std::abs(etfe->frm.G[k](0, 0) - truth);
    tlpm_error += std::abs(tlpm->frm.G[k](0, 0) - truth);
  }
  EXPECT_LT(tlpm_error, 0.05 * etfe_error);
}

TEST(LineAverages, TakeZipperedLinesInputByInput) {
  RandomStream stream = stream_of(3);
  const Eigen::MatrixXd gain = gain_of(2, 2);
  const Measurement m = static_periodic(gain, 3, {{5, 9, 13}, {7, 11, 15}}, {5, 7, 9, 11, 13, 15}, stream);
  for (const EstimationMethod method : {EstimationMethod::etfe, EstimationMethod::tlpm}) {
    const auto estimate = estimate_response(method, {&m, 1}, {});
    ASSERT_TRUE(estimate) << estimate.error().text();
    for (int k = 0; k < 6; ++k) {
      EXPECT_TRUE(estimate->frm.holds(k, k % 2));
      EXPECT_FALSE(estimate->frm.holds(k, 1 - k % 2));
      for (int i = 0; i < 2; ++i) EXPECT_LT(std::abs(estimate->frm.G[k](i, k % 2) - gain(i, k % 2)), 1e-12);
    }
  }
}

TEST(LineAverages, SeparateInputsByExperiments) {
  RandomStream stream = stream_of(4);
  const Eigen::MatrixXd gain = gain_of(3, 2);
  std::vector<Measurement> m;
  const std::vector<int> lines = {5, 9, 13};
  for (int e = 0; e < 3; ++e) m.push_back(static_periodic(gain, 2, {lines, lines}, lines, stream));
  for (const EstimationMethod method :
       {EstimationMethod::etfe, EstimationMethod::tlpm, EstimationMethod::robust}) {
    const auto estimate = estimate_response(method, m, {});
    ASSERT_TRUE(estimate) << estimate.error().text();
    EXPECT_LT(worst_error(estimate->frm, gain), 1e-12);
    EXPECT_EQ(estimate->frm.q, 1);
  }
}

TEST(LineAverages, RefuseOneRecordOfSeveralInputsOnTheSameLines) {
  RandomStream stream = stream_of(5);
  const std::vector<int> lines = {5, 9, 13};
  const Measurement m = static_periodic(gain_of(1, 2), 2, {lines, lines}, lines, stream);
  EXPECT_THAT(estimate_response(EstimationMethod::etfe, {&m, 1}, {}).error().text(),
              HasSubstr("several inputs"));
  EXPECT_THAT(estimate_response(EstimationMethod::robust, {&m, 1}, {}).error().text(),
              HasSubstr("3 or more"));
}

TEST(LineAverages, CallExperimentsWithTheSamePhasesSingular) {
  RandomStream stream = stream_of(6);
  const std::vector<int> lines = {5, 9, 13};
  const Measurement m = static_periodic(gain_of(1, 2), 2, {lines, lines}, lines, stream);
  const std::vector<Measurement> same = {m, m};
  const auto estimate = estimate_response(EstimationMethod::tlpm, same, {});
  ASSERT_TRUE(estimate);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(estimate->frm.status[static_cast<std::size_t>(k)], LineStatus::singular_regressor);
    EXPECT_TRUE(estimate->frm.G[k].allFinite());
  }
}

TEST(ArbitraryLpm, IsExactForAStaticSystemOfThreeInputs) {
  RandomStream stream = stream_of(7);
  const Eigen::MatrixXd gain = gain_of(2, 3);
  Measurement m;
  m.experiment.rate_hz = 50.0;
  m.inputs = white(500, 3, 1.0, stream);
  m.outputs = m.inputs * gain.transpose();
  const auto estimate = estimate_response(EstimationMethod::arbitrary, {&m, 1}, {});
  ASSERT_TRUE(estimate) << estimate.error().text();
  EXPECT_EQ(estimate->frm.line_count(), 249);
  EXPECT_EQ(estimate->frm.q, 7);
  EXPECT_LT(worst_error(estimate->frm, gain), 1e-11);
}

TEST(ArbitraryLpm, SaysWhichWindowLeavesADegreeOfFreedom) {
  RandomStream stream = stream_of(8);
  Measurement m;
  m.experiment.rate_hz = 50.0;
  m.inputs = white(500, 3, 1.0, stream);
  m.outputs = white(500, 1, 1.0, stream);
  EstimatorOptions options;
  options.n_e = 5;
  EXPECT_THAT(estimate_response(EstimationMethod::arbitrary, {&m, 1}, options).error().text(),
              HasSubstr("n_E >= 6"));
}

/// Largest error over the band about the mode, relative to the peak.
double mode_error(const FrmEstimate& e, const Mode& mode) {
  double peak = 0.0, worst = 0.0;
  for (int k = 0; k < e.line_count(); ++k) {
    const std::complex<double> truth = mode.response(e.frequency_hz[static_cast<std::size_t>(k)]);
    peak = std::max(peak, std::abs(truth));
    worst = std::max(worst, std::abs(e.G[k](0, 0) - truth));
  }
  return worst / peak;
}

Measurement mode_record(const Mode& mode, std::uint64_t study) {
  RandomStream stream = stream_of(study);
  Measurement m;
  m.experiment.rate_hz = 1.0;
  m.inputs = white(2048, 1, 1.0, stream);
  m.outputs = mode.simulate(m.inputs.col(0));
  return m;
}

TEST(LocalRational, FollowsALightlyDampedModeToOneInTenMillion) {
  for (const double frequency : {0.05, 0.1, 0.21}) {
    const Mode mode(frequency, 0.02);
    const Measurement m = mode_record(mode, 9);
    const auto rational = estimate_response(EstimationMethod::lrm, {&m, 1}, {});
    const auto polynomial = estimate_response(EstimationMethod::arbitrary, {&m, 1}, {});
    ASSERT_TRUE(rational && polynomial);
    EXPECT_EQ(rational->frm.q, 13 - 8);
    EXPECT_LT(mode_error(rational->frm, mode), 1e-7) << frequency;
    EXPECT_GT(mode_error(polynomial->frm, mode), 1e-3);
    EXPECT_TRUE(rational->fallback.empty());
  }
}

TEST(LocalRational, FollowsTheModeOnPeriodicLinesToo) {
  RandomStream stream = stream_of(10);
  const Mode mode(0.1, 0.02);
  const std::vector<int> lines = consecutive_lines(150, 120);
  Measurement m;
  m.experiment = {lines, 2048, 2, 1.0};
  const Eigen::VectorXd u = multisine(2048, 4, lines, stream);
  m.inputs = u.tail(4096);
  m.outputs = mode.simulate(u).tail(4096);
  const auto estimate = estimate_response(EstimationMethod::lrm, {&m, 1}, {});
  ASSERT_TRUE(estimate) << estimate.error().text();
  EXPECT_LT(mode_error(estimate->frm, mode), 1e-7);
}

TEST(LocalRational, FallsBackToPolynomialsWhereAPoleLiesOnTheGrid) {
  const Measurement m = mode_record(Mode(205.0 / 2048.0, 1e-6), 11);
  const auto estimate = estimate_response(EstimationMethod::lrm, {&m, 1}, {});
  ASSERT_TRUE(estimate);
  EXPECT_THAT(estimate->fallback, testing::Contains(205));
  EXPECT_EQ(estimate->notes.size(), 1U);
  for (int k = 0; k < estimate->frm.line_count(); ++k) {
    EXPECT_TRUE(std::isfinite(estimate->frm.variance(k, 0, 0))) << k;
    EXPECT_TRUE(estimate->frm.G[k].allFinite());
  }
}

TEST(LocalRational, KeepsAStaticSystemWhoseDenominatorIsOpen) {
  RandomStream stream = stream_of(12);
  Measurement m;
  m.experiment.rate_hz = 1.0;
  m.inputs = white(512, 2, 1.0, stream);
  m.outputs = m.inputs * gain_of(2, 2).transpose();
  const auto estimate = estimate_response(EstimationMethod::lrm, {&m, 1}, {});
  ASSERT_TRUE(estimate) << estimate.error().text();
  EXPECT_LT(worst_error(estimate->frm, gain_of(2, 2)), 1e-10);
}

TEST(LocalRational, SharesNoResponseAmongInputsThatCannotBeToldApart) {
  RandomStream stream = stream_of(17);
  Measurement m;
  m.experiment.rate_hz = 1.0;
  m.inputs = white(512, 2, 1.0, stream);
  m.inputs.col(1) = 2.0 * m.inputs.col(0);
  m.outputs = m.inputs * gain_of(2, 2).transpose() + white(512, 2, 0.1, stream);
  const auto estimate = estimate_response(EstimationMethod::lrm, {&m, 1}, {});
  ASSERT_TRUE(estimate) << estimate.error().text();
  for (const LineStatus status : estimate->frm.status) EXPECT_EQ(status, LineStatus::singular_regressor);
}

TEST(ArbitraryLpm, AndLrmEstimateNothingWhereTheInputIsRounding) {
  // An input of bins 50 ... 100, a file of 9 digits: elsewhere only the rounding of the ninth.
  RandomStream stream = stream_of(19);
  const Eigen::VectorXd u = multisine(1024, 1, consecutive_lines(50, 51), stream);
  Measurement m;
  m.experiment.rate_hz = 1.0;
  m.inputs = (u * 1e9).array().round() / 1e9;
  m.outputs = m.inputs + white(1024, 1, 1e-3, stream);
  for (const EstimationMethod method : {EstimationMethod::arbitrary, EstimationMethod::lrm}) {
    const auto estimate = estimate_response(method, {&m, 1}, {});
    ASSERT_TRUE(estimate) << estimate.error().text();
    for (int k = 0; k < estimate->frm.line_count(); ++k) {
      const int bin = estimate->frm.lines[static_cast<std::size_t>(k)];
      const LineStatus status = estimate->frm.status[static_cast<std::size_t>(k)];
      const LineStatus expected = bin < 40 || bin > 110 ? LineStatus::singular_regressor : LineStatus::ok;
      const bool edge = std::min(std::abs(bin - 50), std::abs(bin - 100)) <= 10;  // windows half empty
      EXPECT_TRUE(edge || status == expected) << bin;
    }
  }
}

TEST(LocalRational, GivesTheSameEstimateOnAnyNumberOfThreads) {
  const Measurement m = mode_record(Mode(0.1, 0.02), 18);
  EstimatorOptions options;
  const auto one = estimate_response(EstimationMethod::lrm, {&m, 1}, options);
  options.threads = 3;
  const auto three = estimate_response(EstimationMethod::lrm, {&m, 1}, options);
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one->fallback, three->fallback);
  for (int k = 0; k < one->frm.line_count(); ++k) {
    ASSERT_EQ(one->frm.G[k](0, 0), three->frm.G[k](0, 0));
    ASSERT_EQ(one->frm.variance(k, 0, 0), three->frm.variance(k, 0, 0));
  }
}

TEST(Welch, IsExactForAStaticSystemOfCorrelatedInputs) {
  RandomStream stream = stream_of(13);
  const Eigen::MatrixXd gain = gain_of(2, 2);
  Eigen::MatrixXd mixing(2, 2);
  mixing << 1.0, 0.6, 0.0, 0.8;
  Measurement m;
  m.experiment.rate_hz = 50.0;
  m.inputs = white(4096, 2, 1.0, stream) * mixing;
  m.outputs = m.inputs * gain.transpose();
  const auto estimate = estimate_response(EstimationMethod::welch, {&m, 1}, {});
  ASSERT_TRUE(estimate) << estimate.error().text();
  EXPECT_LT(worst_error(estimate->frm, gain), 1e-12);
  for (int k = 0; k < estimate->frm.line_count(); ++k) EXPECT_NEAR(estimate->coherence[k](1, 0), 1.0, 1e-12);
}

TEST(Welch, RefusesSegmentsThatAreTooFew) {
  RandomStream stream = stream_of(14);
  Measurement m;
  m.experiment.rate_hz = 50.0;
  m.inputs = white(512, 2, 1.0, stream);
  m.outputs = white(512, 1, 1.0, stream);
  EstimatorOptions options;
  options.welch.segment_samples = 400;
  EXPECT_THAT(estimate_response(EstimationMethod::welch, {&m, 1}, options).error().text(),
              HasSubstr("shorter"));
}

TEST(Welch, CountsHalfOverlappingHannSegmentsAsWelchDoes) {
  // rho of half-overlapping Hann windows is 1/6.
  EXPECT_NEAR(effective_segments(15, 1024, 512, Taper::hann), 15.0 / (1.0 + 2.0 * (14.0 / 15.0) / 36.0),
              1e-3);
  EXPECT_NEAR(effective_segments(8, 1024, 1024, Taper::none), 8.0, 1e-12);
}

TEST(Estimators, KnowTheirNames) {
  EXPECT_EQ(estimation_method("lrm"), EstimationMethod::lrm);
  EXPECT_FALSE(estimation_method("magic"));
  EXPECT_EQ(estimation_method_names(), "lpm, tlpm, etfe, lrm, arbitrary, robust, welch");
}

}  // namespace
}  // namespace fatmc
