// Joint distance, nonlinear distortion, widths of modes, noise model, design of an experiment for a mode.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/ident/interpolation_bias.h"
#include "core/ident/joint_distance.h"
#include "core/ident/mode_design.h"
#include "core/ident/noise_model.h"
#include "core/ident/nonlinear_distortion.h"
#include "core/signal/multisine.h"
#include "core/stats/confidence_regions.h"
#include "core/stats/intervals.h"
#include "core/stats/lawley_hotelling.h"
#include "tests/unit/ident/synthetic_experiment.h"

namespace fatmc {
namespace {

using namespace test;

TEST(JointDistance, IsTheQuadraticFormOfTheKroneckerProduct) {
  RandomStream stream({1, 0, 0, 0}, "quality");
  const LpmGrid grid = make_grid(consecutive_lines(50, 21), 2, {6, 2, 5});
  FastLpm lpm(grid, 3);
  const LineSpectra reference = random_phases(grid, stream);
  const Spectra z = closed_loop(grid, reference, random_polynomial(3, 2, 1, stream),
                                random_polynomial(2, 2, 1, stream), random_mixing(5, 0.1, stream), 3, stream);
  lpm.load_spectra(z.outputs, z.inputs);
  const FrmEstimate& e = lpm.indirect(reference);
  const int k = 9;
  const Eigen::MatrixXcd truth = Eigen::MatrixXcd::Random(3, 2);
  Eigen::MatrixXcd full(6, 6);
  for (int j = 0; j < 2; ++j) {
    for (int m = 0; m < 2; ++m) full.block(3 * j, 3 * m, 3, 3) = e.B[k](j, m) * e.C_V[k];
  }
  const Eigen::VectorXcd error = Eigen::MatrixXcd(e.G[k] - truth).reshaped();
  const double expected = error.dot(full.partialPivLu().solve(error)).real();
  EXPECT_NEAR(joint_distance(e, k, truth).value() / expected, 1.0, 1e-10);
}

TEST(JointDistance, FollowsTheLawleyHotellingLaw) {
  const LpmGrid grid =
      make_grid(consecutive_lines(50, 19), 3);  // one window: its middle line is estimated freely
  RandomStream design({2, 0, 0, 0}, "quality");
  const Response g = random_polynomial(3, 3, 2, design), g_ur = random_polynomial(3, 3, 0, design);
  const Eigen::MatrixXcd mixing = random_mixing(6, 0.01, design);
  const ComplexLawleyHotelling law(3, 3, grid.q());
  const std::array<double, 3> levels = {0.75, 0.95, 0.99};
  std::array<double, 3> limits{};
  for (std::size_t l = 0; l < 3; ++l) limits[l] = law.quantile(levels[l]).value;
  std::array<int, 3> inside{};
  const int runs = 3'000;
  FastLpm lpm(grid, 3);
  for (int run = 0; run < runs; ++run) {
    RandomStream stream({3, 0, 0, static_cast<std::uint64_t>(run)}, "quality");
    const LineSpectra reference = random_phases(grid, stream);
    const Spectra z = closed_loop(grid, reference, g, g_ur, mixing, 3, stream);
    lpm.load_spectra(z.outputs, z.inputs);
    const double distance = joint_distance(lpm.indirect(reference), 9, g(grid.frequency_hz(9))).value();
    for (std::size_t l = 0; l < 3; ++l) inside[l] += distance <= limits[l] ? 1 : 0;
  }
  for (std::size_t l = 0; l < 3; ++l) {
    const double band = 3.0 * std::sqrt(levels[l] * (1.0 - levels[l]) / runs);
    EXPECT_NEAR(static_cast<double>(inside[l]) / runs, levels[l], band) << levels[l];
  }
}

TEST(JointDistance, HasNoneWhereTheCovarianceIsSingular) {
  RandomStream stream({4, 0, 0, 0}, "quality");
  const LpmGrid grid = make_grid(consecutive_lines(50, 19), 3, {5, 2, 5});  // q = 2 < 3 outputs
  FastLpm lpm(grid, 3);
  const LineSpectra reference = random_phases(grid, stream);
  const Spectra z = closed_loop(grid, reference, random_polynomial(3, 3, 1, stream),
                                random_polynomial(3, 3, 1, stream), random_mixing(6, 0.1, stream), 3, stream);
  lpm.load_spectra(z.outputs, z.inputs);
  EXPECT_FALSE(joint_distance(lpm.indirect(reference), 9, Eigen::MatrixXcd::Zero(3, 3)));
}

/// One input, one output, `distortion` added to the output at excited bins alone.
FrmEstimate distorted(const LpmGrid& grid, double distortion, std::uint64_t run) {
  RandomStream stream({5, 0, 0, run}, "quality");
  const LineSpectra reference = random_phases(grid, stream);
  const Response one = [](double) { return Eigen::MatrixXcd::Identity(1, 1).eval(); };
  Spectra z = closed_loop(grid, reference, one, one, 0.1 * Eigen::MatrixXcd::Identity(2, 2), 1, stream);
  for (int k = 0; k < grid.line_count(); ++k)
    z.outputs(grid.bin(k), 0) += distortion * complex_normal(stream);
  FastLpm lpm(grid, 1);
  lpm.load_spectra(z.outputs, z.inputs);
  return lpm.indirect(reference);
}

TEST(NonlinearDistortion, IsTheVarianceThatExcitedLinesHaveAndOthersLack) {
  const LpmGrid grid = make_grid(consecutive_lines(50, 40), 1);
  std::vector<double> variances;
  for (std::uint64_t run = 0; run < 200; ++run) {
    const FrmEstimate e = distorted(grid, 0.3, run);
    variances.push_back(e.C_Z[20](0, 0).real() - e.C_Z_noise[20](0, 0).real());
    EXPECT_GE(distortion_variance(e, 20, 0), 0.0);
  }
  const RunMean mean = mean_over_runs(variances);
  EXPECT_NEAR(mean.mean, 0.09, 3.0 * mean.standard_error);
}

TEST(NonlinearDistortion, ItsTestFindsDistortion) {
  const LpmGrid grid = make_grid(consecutive_lines(50, 40), 1);
  std::vector<double> found;
  for (std::uint64_t run = 0; run < 100; ++run) {
    found.push_back(nonlinear_distortion(distorted(grid, 0.3, run), 0.05).above[0] / 40.0);
  }
  EXPECT_GT(mean_over_runs(found).mean, 0.9);
}

/// Share of outputs and lines that the test rejects at 5 % where there is white noise alone, over runs.
RunMean rejected(const LpmGrid& grid, int n, int runs) {
  RandomStream design({8, 0, 0, 0}, "quality");
  const Response g = random_polynomial(n, n, 2, design), g_ur = random_polynomial(n, n, 0, design);
  const Eigen::MatrixXcd mixing = random_mixing(2 * n, 0.01, design);
  FastLpm lpm(grid, n);
  std::vector<double> shares;
  for (int run = 0; run < runs; ++run) {
    RandomStream stream({9, 0, 0, static_cast<std::uint64_t>(run)}, "quality");
    const LineSpectra reference = random_phases(grid, stream);
    const Spectra z = closed_loop(grid, reference, g, g_ur, mixing, n, stream);
    lpm.load_spectra(z.outputs, z.inputs);
    double share = 0.0;
    for (const int above : nonlinear_distortion(lpm.indirect(reference), 0.05).above) share += above;
    shares.push_back(share / (n * grid.line_count()));
  }
  return mean_over_runs(shares);
}

TEST(NonlinearDistortion, ItsTestRejectsNoiseAsOftenAsItSays) {
  const std::vector<int> table = lines_from_ranges(table_5_1_ranges(), 0.005).value();
  const RunMean one = rejected(make_grid(consecutive_lines(50, 40), 1), 1, 1'000);
  const RunMean three = rejected(make_grid(table, 3), 3, 1'000);
  EXPECT_NEAR(one.mean, 0.05, 3.0 * one.standard_error);
  EXPECT_NEAR(three.mean, 0.05, 3.0 * three.standard_error);
  for (const auto& [name, rate] : {std::pair{"one", one}, std::pair{"three", three}}) {
    RecordProperty(std::string(name) + "_percent", std::to_string(100.0 * rate.mean));
    RecordProperty(std::string(name) + "_error", std::to_string(100.0 * rate.standard_error));
  }
}

/// G = 1/(1 + 2j (f - f_c)/width) at every line.
FrmEstimate peak_at(const LpmGrid& grid, int centre, double width_hz) {
  FrmEstimate e;
  e.n_out = e.n_in = 1;
  e.lines = grid.experiment().lines;
  e.G.resize(1, 1, grid.line_count());
  for (int k = 0; k < grid.line_count(); ++k) {
    e.G[k](0, 0) = 1.0 / Complex(1.0, 2.0 * (grid.frequency_hz(k) - grid.frequency_hz(centre)) / width_hz);
  }
  return e;
}

TEST(ThreeDbRange, AtAPeakIs054Or021OfTheWidthWithoutAndWithTheLinearTerm) {
  const LpmGrid grid = make_grid(consecutive_lines(50, 19), 1);
  const double width = 2'000.0 * (grid.frequency_hz(1) - grid.frequency_hz(0));  // a hundred windows
  const FrmEstimate e = peak_at(grid, 9, width);
  const double k = 1.0 / std::numbers::sqrt2;
  EXPECT_NEAR(three_db_range_hz(grid, e, ThreeDbRule::linear_dropped)[9](0, 0) / width, std::sqrt(1.0 - k),
              0.01);
  EXPECT_NEAR(three_db_range_hz(grid, e, ThreeDbRule::linear_kept)[9](0, 0) / width, std::sqrt(0.75 - k),
              0.01);
}

TEST(BiasConstant, OfTheActualOffsetsIsThatOfASmallWindow) {
  for (const int n : {3, 9, 200}) {
    const LpmGrid grid = *uniform_window(0.01, n, 2);
    double m2 = 0.0, m4 = 0.0, m6 = 0.0;
    for (int i = -n; i <= n; ++i) {
      m2 += std::pow(i, 2);
      m4 += std::pow(i, 4);
      m6 += std::pow(i, 6);
    }
    // Quadratic through i^4: its constant term by the normal equations.
    const double count = 2.0 * n + 1.0, moment = (m4 * m4 - m2 * m6) / (count * m4 - m2 * m2);
    EXPECT_NEAR(bias_constant(grid, n, BiasConstant::exact_offsets), -moment / std::pow(0.5 * count, 4),
                1e-9);
    EXPECT_NEAR(bias_constant(grid, n, BiasConstant::limit), 3.0 / 35.0, 1e-15);
    EXPECT_NEAR(bias_constant(grid, n, BiasConstant::printed), 0.0857, 1e-15);
  }
  EXPECT_NEAR(bias_constant(*uniform_window(0.01, 200, 2), 200, BiasConstant::exact_offsets), 3.0 / 35.0,
              1e-5);
}

TEST(ModeDesign, ReproducesTable31AndItsTolerance) {
  const ModeRequirement short_period = mode_requirement({0.484, 0.665}, 9, 2, 1e-4);
  EXPECT_NEAR(short_period.b_3db_hz, 2.0 * 0.484 * 0.665, 1e-12);
  EXPECT_NEAR(short_period.duration_table_s, 14.6, 0.1);
  EXPECT_LT(short_period.duration_corrected_s, short_period.duration_table_s);
  // Lines as far apart as asked for show the peak with just that bias, to leading order.
  const Mode narrow = {1.0, 0.01};
  for (const double bias : {1e-3, 1e-5}) {
    const double spacing = mode_requirement(narrow, 9, 2, bias).spacing_hz;
    const PeakBias peak = peak_bias(*uniform_window(spacing, 9, 2), 9, narrow);
    EXPECT_NEAR(peak.limit / bias, 1.0, 1e-9);
    EXPECT_NEAR(peak.exact / peak.discrete, 1.0,
                30.0 * std::sqrt(bias));  // the next order is two powers of x higher
  }
}

TEST(NoiseModel, RadiiHoldFurtherNoiseAsOftenAsTheySay) {
  const int segment = 64, segments = 12, runs = 1'500, bin = 10;
  RandomStream stream({6, 0, 0, 0}, "quality");
  const double one = *region_radius(RegionKind::univariate, 0.9, 1, 1, segments - 1);
  const double all = *region_radius(RegionKind::joint, 0.9, 3, 1, segments - 1);
  int held = 0, held_all = 0;
  for (int run = 0; run < runs; ++run) {
    Eigen::MatrixXd x(segment * (segments + 1), 3);
    for (auto& value : x.reshaped()) value = stream.normal();
    x.col(1) += x.col(0);
    const Result<NoiseModel> model = noise_model(x.topRows(segment * segments), 50.0, segment);
    ASSERT_TRUE(model);
    // A segment that the model has not seen.
    Eigen::Vector3cd v = Eigen::Vector3cd::Zero();
    for (int n = 0; n < segment; ++n) {
      v += std::polar(1.0 / std::sqrt(segment), -2.0 * std::numbers::pi * bin * n / segment) *
           x.row(segment * segments + n).transpose();
    }
    const Eigen::Matrix3cd c = model->covariance[bin - 1];
    held += std::abs(v(0)) <= one * std::sqrt(c(0, 0).real()) ? 1 : 0;
    held_all += v.dot(c.partialPivLu().solve(v)).real() <= all * all ? 1 : 0;
  }
  const double band = 3.0 * std::sqrt(0.9 * 0.1 / runs);
  EXPECT_NEAR(static_cast<double>(held) / runs, 0.9, band);
  EXPECT_NEAR(static_cast<double>(held_all) / runs, 0.9, band);
}

TEST(NoiseModel, HasTheDensityOfWhiteNoise) {
  RandomStream stream({7, 0, 0, 0}, "quality");
  Eigen::MatrixXd x(20'000, 1);
  for (auto& value : x.reshaped()) value = 0.2 * stream.normal();
  const NoiseModel model = *noise_model(x, 50.0, 200);
  EXPECT_EQ(model.segments, 100);
  std::vector<double> density;
  for (int k = 0; k < static_cast<int>(model.frequency_hz.size()); ++k)
    density.push_back(model.density(k, 0));
  const RunMean mean = mean_over_runs(density);
  EXPECT_NEAR(mean.mean, 0.04 / 50.0, 3.0 * mean.standard_error);
  EXPECT_NEAR(model.frequency_hz.front(), 0.25, 1e-12);
}

TEST(NoiseModel, NeedsTwoSegments) {
  const auto model = noise_model(Eigen::MatrixXd::Zero(100, 1), 50.0, 51);
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().key, "segment");
  EXPECT_EQ(required_segments(0.1), 101);
  EXPECT_EQ(required_segments(0.5), 5);
}

}  // namespace
}  // namespace fatmc
