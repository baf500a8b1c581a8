// Laws of the estimators beside the fast LPM: bands are 3 or 4 standard errors from the scatter between runs.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <array>
#include <cstdio>

#include "core/ident/estimators.h"
#include "core/ident/line_averages.h"
#include "core/stats/confidence.h"
#include "core/stats/intervals.h"
#include "tests/unit/ident/measured_system.h"
#include "tests/unit/ident/synthetic_experiment.h"

namespace fatmc {
namespace {

using namespace test;

constexpr std::array<double, 4> kLevels = {0.75, 0.90, 0.95, 0.99};
using Experiments = std::function<std::vector<Measurement>(RandomStream&)>;

/// Coverage of a static gain, a share a run and level.
void expect_f_law(EstimationMethod method, const EstimatorOptions& options, const Eigen::MatrixXd& gain,
                  int q, int runs, std::uint64_t seed, const Experiments& experiments) {
  std::array<std::vector<double>, 4> shares;
  for (int run = 0; run < runs; ++run) {
    RandomStream stream({seed, 0, 0, static_cast<std::uint64_t>(run)}, "law");
    const std::vector<Measurement> records = experiments(stream);
    const auto estimate = estimate_response(method, records, options);
    ASSERT_TRUE(estimate) << estimate.error().text();
    const FrmEstimate& e = estimate->frm;
    ASSERT_EQ(e.q, q);
    std::array<double, 4> inside{};
    for (int k = 0; k < e.line_count(); ++k) {
      for (int i = 0; i < e.n_out; ++i) {
        for (int j = 0; j < e.n_in; ++j) {
          const double ratio = std::norm(e.G[k](i, j) - gain(i, j)) / e.variance(k, i, j);
          for (std::size_t l = 0; l < 4; ++l) inside[l] += ratio < f_quantile_2_2q(kLevels[l], q) ? 1.0 : 0.0;
        }
      }
    }
    for (std::size_t l = 0; l < 4; ++l) {
      shares[l].push_back(inside[l] / (static_cast<double>(gain.size()) * e.line_count()));
    }
  }
  for (std::size_t l = 0; l < 4; ++l) {
    const RunMean mean = mean_over_runs(shares[l]);
    EXPECT_NEAR(mean.mean, kLevels[l], 3.0 * mean.standard_error) << "level " << kLevels[l];
  }
}

/// One input, noise on input and output, correlated (SNR of the input about 30 dB a line).
Experiments single_input(int periods) {
  return [periods](RandomStream& stream) {
    const std::vector<int> lines = {10, 13, 16, 19, 22, 25, 28, 31, 34, 37, 40, 43};
    Measurement m;
    m.experiment = {lines, 256, periods, 50.0};
    m.inputs = multisine(256, periods, lines, stream);
    m.outputs = 2.0 * m.inputs;
    const Eigen::MatrixXd common = white(256 * periods, 1, 0.1, stream);
    m.outputs += white(256 * periods, 1, 0.3, stream) - common;
    m.inputs += white(256 * periods, 1, 0.1, stream) + common;
    return std::vector<Measurement>{m};
  };
}

const Eigen::MatrixXd kTwo = Eigen::MatrixXd::Constant(1, 1, 2.0);

TEST(EtfeLaw, IsFOf2And2TimesPeriodsLessOne) {
  for (const int periods : {5, 8}) {
    expect_f_law(EstimationMethod::etfe, {}, kTwo, periods - 1, 2000, 300, single_input(periods));
  }
}

TEST(TransientLpmLaw, IsFOf2And2TimesPeriodsLessOne) {
  for (const int periods : {5, 6, 8}) {
    expect_f_law(EstimationMethod::tlpm, {}, kTwo, periods - 1, 2000, 301, single_input(periods));
  }
}

/// Several outputs of one input: G's error e has covariance B C_V, so that e^H C_V^-1 e / B is Hotelling's
/// T^2, n q/(q - n + 1) F(2n, 2(q - n + 1)) for n outputs; discs at Bonferroni's level hold together at least
/// as often.
void expect_joint_law(EstimationMethod method, int periods, int runs, std::uint64_t seed) {
  constexpr int kOutputs = 3;
  const std::vector<int> lines = {10, 13, 16, 19, 22, 25, 28, 31, 34, 37, 40, 43};
  const Eigen::Vector3d gain(2.0, -0.5, 1.0);
  std::array<std::vector<double>, 4> jointly, together;
  for (int run = 0; run < runs; ++run) {
    RandomStream stream({seed, 0, 0, static_cast<std::uint64_t>(run)}, "joint");
    Measurement m;
    m.experiment = {lines, 256, periods, 50.0};
    m.inputs = multisine(256, periods, lines, stream);
    const Eigen::MatrixXd common = white(256 * periods, 1, 0.2, stream);
    m.outputs = m.inputs * gain.transpose() + white(256 * periods, kOutputs, 0.3, stream);
    m.outputs += common * Eigen::RowVector3d(1.0, -1.0, 0.5);
    m.inputs += white(256 * periods, 1, 0.1, stream) + 0.5 * common;
    const auto estimate = estimate_response(method, {&m, 1}, {});
    ASSERT_TRUE(estimate) << estimate.error().text();
    const FrmEstimate& e = estimate->frm;
    const double rest = e.q - kOutputs + 1;
    std::array<double, 4> hotelling{}, discs{};
    for (int k = 0; k < e.line_count(); ++k) {
      const Eigen::Vector3cd error = e.G[k].col(0) - gain.cast<std::complex<double>>();
      const Eigen::Matrix3cd c_v = e.C_V[k];
      const double t2 = (error.adjoint() * c_v.llt().solve(error))(0, 0).real() / e.B[k](0, 0).real();
      for (std::size_t l = 0; l < 4; ++l) {
        hotelling[l] +=
            t2 <= kOutputs * e.q / rest * f_quantile(kLevels[l], 2.0 * kOutputs, 2.0 * rest) ? 1.0 : 0.0;
        const double limit = f_quantile_2_2q(bonferroni_level(kLevels[l], kOutputs), e.q);
        bool all = true;
        for (int i = 0; i < kOutputs; ++i) all = all && std::norm(error(i)) <= limit * e.variance(k, i, 0);
        discs[l] += all ? 1.0 : 0.0;
      }
    }
    for (std::size_t l = 0; l < 4; ++l) {
      jointly[l].push_back(hotelling[l] / e.line_count());
      together[l].push_back(discs[l] / e.line_count());
    }
  }
  for (std::size_t l = 0; l < 4; ++l) {
    const RunMean mean = mean_over_runs(jointly[l]), bound = mean_over_runs(together[l]);
    EXPECT_NEAR(mean.mean, kLevels[l], 3.0 * mean.standard_error) << "Hotelling, level " << kLevels[l];
    EXPECT_GE(bound.mean, kLevels[l] - 3.0 * bound.standard_error) << "Bonferroni, level " << kLevels[l];
  }
}

TEST(EtfeLaw, HoldsForAllOutputsTogether) {
  for (const int periods : {5, 8}) expect_joint_law(EstimationMethod::etfe, periods, 1000, 310);
}

TEST(TransientLpmLaw, HoldsForAllOutputsTogether) {
  for (const int periods : {5, 8}) expect_joint_law(EstimationMethod::tlpm, periods, 1000, 311);
}

TEST(TransientLpmLaw, FollowsTheBinsThatItIsGiven) {
  EstimatorOptions options;
  options.n_transient = 5;
  expect_f_law(EstimationMethod::tlpm, options, kTwo, 7, 1000, 302, single_input(5));
}

TEST(RobustLaw, IsFOfTheExperimentsThatAreLeftOver) {
  Eigen::MatrixXd gain(2, 2);
  gain << 1.0, -0.4, 0.3, 2.0;
  expect_f_law(EstimationMethod::robust, {}, gain, 4, 1000, 303, [&](RandomStream& stream) {
    std::vector<Measurement> records;
    for (int e = 0; e < 6; ++e) {
      const std::vector<int> lines = {10, 14, 18, 22};
      Measurement m;
      m.experiment = {lines, 128, 2, 50.0};
      m.inputs.resize(256, 2);
      for (int j = 0; j < 2; ++j) m.inputs.col(j) = multisine(128, 2, lines, stream);
      m.outputs = m.inputs * gain.transpose() + white(256, 2, 0.3, stream);
      records.push_back(m);
    }
    return records;
  });
}

Experiments white_inputs(const Eigen::MatrixXd& gain, int samples) {
  return [gain, samples](RandomStream& stream) {
    Measurement m;
    m.experiment.rate_hz = 50.0;
    m.inputs = white(samples, static_cast<int>(gain.cols()), 1.0, stream);
    m.outputs = m.inputs * gain.transpose() + white(samples, static_cast<int>(gain.rows()), 0.4, stream);
    return std::vector<Measurement>{m};
  };
}

TEST(ArbitraryLpmLaw, IsFOfTheWindowsDegreesOfFreedom) {
  Eigen::MatrixXd gain(1, 2);
  gain << 1.0, -0.4;
  expect_f_law(EstimationMethod::arbitrary, {}, gain, 10, 600, 304, white_inputs(gain, 200));
}

TEST(WelchLaw, IsFForSegmentsThatDoNotOverlap) {
  Eigen::MatrixXd gain(1, 2);
  gain << 1.0, -0.4;
  EstimatorOptions options;
  options.welch = {64, 0.0, Taper::none};
  expect_f_law(EstimationMethod::welch, options, gain, 14, 600, 305, white_inputs(gain, 1024));
}

// No exact law: noise stands in the regressor. With moderate noise the band below is what the F law of the
// linear problem misses by.
TEST(LocalRationalCoverage, StaysWithinFivePointsOfTheNominalLevels) {
  const Mode mode(0.1, 0.05);
  std::array<std::vector<double>, 4> shares;
  for (int run = 0; run < 500; ++run) {
    RandomStream stream({306, 0, 0, static_cast<std::uint64_t>(run)}, "law");
    Measurement m;
    m.experiment.rate_hz = 1.0;
    m.inputs = white(512, 1, 1.0, stream);
    m.outputs = mode.simulate(m.inputs.col(0)) + white(512, 1, 1e-3, stream);
    m.experiment.lines = {40, 60};
    m.experiment.periods = 1;
    EstimatorOptions options;
    options.n_e = 9;
    const auto estimate = estimate_response(EstimationMethod::lrm, {&m, 1}, options);
    ASSERT_TRUE(estimate);
    const FrmEstimate& e = estimate->frm;
    std::array<double, 4> inside{};
    for (int k = 0; k < e.line_count(); ++k) {
      const double error =
          std::norm(e.G[k](0, 0) - mode.response(e.frequency_hz[static_cast<std::size_t>(k)]));
      for (std::size_t l = 0; l < 4; ++l) {
        inside[l] +=
            error / e.variance(k, 0, 0) < f_quantile_2_2q(kLevels[l], e.q) ? 1.0 / e.line_count() : 0.0;
      }
    }
    for (std::size_t l = 0; l < 4; ++l) shares[l].push_back(inside[l]);
  }
  for (std::size_t l = 0; l < 4; ++l) {
    const RunMean mean = mean_over_runs(shares[l]);
    std::printf("LRM, nominal %.0f %%: %.1f %% (standard error %.1f)\n", 100.0 * kLevels[l],
                100.0 * mean.mean, 100.0 * mean.standard_error);
    EXPECT_NEAR(mean.mean, kLevels[l], 0.05);
  }
}

TEST(EtfeBias, IsThatOfARatioOfComplexNormals) {
  // SNRs at which the bias is a third of the response, errors correlated by -0.6 + 0.3j.
  const double input_snr = 1.1, output_snr = 1.6;
  const std::complex<double> rho(-0.6, 0.3);
  RandomStream stream({307, 0, 0, 0}, "bias");
  // E[Y/U] has infinite variance; its real part conditional on |1 + v_u| = x has none: with v_y = c v_u +
  // rest the ratio is c + (1 - c)/(1 + v_u), and the mean of 1/(1 + v_u) over the angle of v_u is 1 where
  // |v_u| < 1 and 0 beyond.
  const std::complex<double> c = rho * (input_snr / output_snr);
  std::vector<double> share;
  for (int run = 0; run < 200; ++run) {
    double below = 0.0;
    for (int i = 0; i < 500; ++i)
      below += std::abs(complex_normal(stream)) / input_snr < 1.0 ? 1.0 / 500 : 0.0;
    share.push_back(below);
  }
  const RunMean mean = mean_over_runs(share);
  const std::complex<double> expected = relative_etfe_bias(input_snr, output_snr, rho);
  const std::complex<double> observed = c + (1.0 - c) * mean.mean - 1.0;
  EXPECT_LT(std::abs(observed - expected), 4.0 * std::abs(1.0 - c) * mean.standard_error);
}

}  // namespace
}  // namespace fatmc
