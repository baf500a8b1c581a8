#include "core/ident/fast_lpm.h"

#include <gtest/gtest.h>

#include "core/signal/multisine.h"
#include "tests/unit/ident/synthetic_experiment.h"

namespace fatmc {
namespace {

using namespace test;

std::vector<int> table_lines() { return lines_from_ranges(table_5_1_ranges(), 0.005).value(); }

double worst_relative_error(const LpmGrid& grid, const FrmEstimate& estimate, const Response& g) {
  double worst = 0.0;
  for (int k = 0; k < estimate.line_count(); ++k) {
    const Eigen::MatrixXcd truth = g(grid.frequency_hz(k));
    worst = std::max(worst, (estimate.G[k] - truth).cwiseAbs().maxCoeff() / truth.cwiseAbs().maxCoeff());
  }
  return worst;
}

TEST(FastLpm, RecoversAPolynomialResponseToRoundOffDirectly) {
  RandomStream stream({1, 0, 0, 0}, "test");
  for (const int n_in : {1, 2, 3}) {
    const LpmGrid grid = make_grid(table_lines(), n_in);
    const Response g = random_polynomial(3, n_in, 2, stream);
    const Response g_ur = [&](double) { return Eigen::MatrixXcd::Identity(n_in, n_in); };
    const LineSpectra reference = random_phases(grid, stream);
    const Spectra z = closed_loop(grid, reference, g, g_ur, Eigen::MatrixXcd::Zero(3 + n_in, 3 + n_in), 3, stream);
    FastLpm lpm(grid, 3);
    lpm.load_spectra(z.outputs, z.inputs);
    EXPECT_LT(worst_relative_error(grid, lpm.direct(), g), 1e-12) << n_in;
    EXPECT_EQ(lpm.direct().q, 19 - 3 * n_in);
    EXPECT_LT(lpm.direct().variance(5, 0, 0), 1e-25);
  }
}

TEST(FastLpm, RecoversAPolynomialResponseToRoundOffIndirectly) {
  RandomStream stream({2, 0, 0, 0}, "test");
  for (const int order : {1, 2, 4}) {
    const LpmGrid grid = make_grid(table_lines(), 3, {.n_e = 12, .order = order});
    const Response g = random_polynomial(2, 3, order / 2, stream);
    const Response g_ur = random_polynomial(3, 3, order - order / 2, stream);
    const LineSpectra reference = random_phases(grid, stream);
    const Spectra z = closed_loop(grid, reference, g, g_ur, Eigen::MatrixXcd::Zero(5, 5), 2, stream);
    FastLpm lpm(grid, 2);
    lpm.load_spectra(z.outputs, z.inputs);
    EXPECT_LT(worst_relative_error(grid, lpm.indirect(reference), g), 1e-10) << order;
  }
}

TEST(FastLpm, RecoversAllElementsAtAllLinesFromZipperedReferences) {
  RandomStream stream({12, 0, 0, 0}, "test");
  const LpmGrid grid = make_grid(table_lines(), 3);
  const Response g = random_polynomial(3, 3, 1, stream), g_ur = random_polynomial(3, 3, 1, stream);
  LineSpectra reference = random_phases(grid, stream);
  for (int k = 0; k < grid.line_count(); ++k) {
    for (int j = 0; j < 3; ++j) reference(k, j) *= k % 3 == j ? 1.0 : 0.0;
  }
  const Spectra z = closed_loop(grid, reference, g, g_ur, Eigen::MatrixXcd::Zero(6, 6), 3, stream);
  FastLpm lpm(grid, 3);
  lpm.load_spectra(z.outputs, z.inputs);
  EXPECT_LT(worst_relative_error(grid, lpm.indirect(reference), g), 1e-10);
}

TEST(FastLpm, GivesTheSameBitsWithAPreparedDesign) {
  RandomStream stream({3, 0, 0, 0}, "test");
  const LpmGrid grid = make_grid(table_lines(), 3);
  const Response g = random_polynomial(3, 3, 2, stream), g_ur = random_polynomial(3, 3, 2, stream);
  const LineSpectra reference = random_phases(grid, stream);
  const Spectra z = closed_loop(grid, reference, g, g_ur, random_mixing(6, 0.1, stream), 3, stream);
  FastLpm lpm(grid, 3);
  lpm.load_spectra(z.outputs, z.inputs);
  const FrmEstimate cold = lpm.indirect(reference);
  const LpmDesign design(grid, reference);
  const FrmEstimate& prepared = lpm.indirect(design);
  for (int k = 0; k < grid.line_count(); ++k) {
    EXPECT_TRUE((cold.G[k].array() == prepared.G[k].array()).all());
    EXPECT_TRUE((cold.B[k].array() == prepared.B[k].array()).all());
    EXPECT_TRUE((cold.C_V[k].array() == prepared.C_V[k].array()).all());
  }
}

// The formulas of the header once more, written with explicit inverses and a Kronecker product.
TEST(FastLpm, AgreesWithTheTextbookFormulasWrittenOut) {
  RandomStream stream({4, 0, 0, 0}, "test");
  const LpmGrid grid = make_grid(table_lines(), 3);
  const Response g = random_polynomial(3, 3, 2, stream), g_ur = random_polynomial(3, 3, 2, stream);
  const LineSpectra reference = random_phases(grid, stream);
  const Spectra z = closed_loop(grid, reference, g, g_ur, random_mixing(6, 0.1, stream), 3, stream);
  FastLpm lpm(grid, 3);
  lpm.load_spectra(z.outputs, z.inputs);
  const FrmEstimate& estimate = lpm.indirect(reference);
  Eigen::MatrixXcd all(grid.bin_count(), 6);
  all << z.outputs, z.inputs;
  Eigen::MatrixXcd mean(grid.line_count(), 6);
  for (int k = 0; k < grid.line_count(); ++k) {
    Eigen::MatrixXcd z_n(6, 10);
    Eigen::MatrixXd k_n(3, 10);
    for (int i = 0; i < 10; ++i) {
      const int m = grid.transient().bins(k)[static_cast<std::size_t>(i)];
      z_n.col(i) = all.row(m).transpose();
      const double r = m - grid.bin(k);
      k_n.col(i) << 1.0, r, r * r;
    }
    const Eigen::MatrixXcd theta = z_n * k_n.transpose() * (k_n * k_n.transpose()).inverse();
    mean.row(k) = all.row(grid.bin(k)) - theta.col(0).transpose();
    const Eigen::MatrixXcd residual = z_n - theta * k_n;
    const Eigen::MatrixXcd noise = grid.transient().mu_poly(k) * residual * residual.adjoint() / 7.0;
    EXPECT_LT((estimate.C_Z_noise[k] - noise).norm(), 1e-9 * noise.norm());
    const double mu = 1.0 + (k_n * k_n.transpose()).inverse()(0, 0);
    EXPECT_NEAR(grid.transient().mu_poly(k), mu, 1e-8 * mu);
  }
  for (int k = 0; k < grid.line_count(); ++k) {
    Eigen::MatrixXcd z_n(6, 19), l(9, 19);
    for (int w = 0; w < 19; ++w) {
      z_n.col(w) = mean.row(grid.first(k) + w).transpose();
      const double d = grid.offsets_hz(k)[static_cast<std::size_t>(w)];
      const Eigen::VectorXcd r = reference.row(grid.first(k) + w).transpose();
      l.col(w) << r, d * r, d * d * r;
    }
    const Eigen::MatrixXcd s = (l.adjoint() * (l * l.adjoint()).inverse());
    const Eigen::MatrixXcd theta = z_n * s;
    const Eigen::MatrixXcd c_z = (z_n - theta * l) * (z_n - theta * l).adjoint() / 10.0;
    const Eigen::MatrixXcd g_yr = theta.topLeftCorner(3, 3), g_ur_hat = theta.block(3, 0, 3, 3);
    const Eigen::MatrixXcd g_hat = g_yr * g_ur_hat.inverse();
    Eigen::MatrixXcd v(3, 6);
    v << Eigen::MatrixXcd::Identity(3, 3), -g_hat;
    const Eigen::MatrixXcd a = (s.leftCols(3).adjoint() * s.leftCols(3)).conjugate();
    const Eigen::MatrixXcd inverse = g_ur_hat.inverse();
    const Eigen::MatrixXcd b = inverse.transpose() * a * inverse.conjugate();
    const Eigen::MatrixXcd c_v = v * c_z * v.adjoint();
    EXPECT_LT((estimate.G[k] - g_hat).norm(), 1e-7 * g_hat.norm()) << k;
    EXPECT_LT((estimate.B[k] - b).norm(), 1e-7 * b.norm()) << k;
    EXPECT_LT((estimate.C_V[k] - c_v).norm(), 1e-7 * c_v.norm()) << k;
    EXPECT_LT((estimate.C_Z[k] - c_z).norm(), 1e-7 * c_z.norm()) << k;
    const Eigen::MatrixXcd c_v_noise = v * estimate.C_Z_noise[k] * v.adjoint();
    EXPECT_LT((estimate.C_V_noise[k] - c_v_noise).norm(), 1e-7 * c_v_noise.norm()) << k;
  }
}

TEST(FastLpm, RemovesATransientThatIsSmoothInFrequency) {
  RandomStream stream({5, 0, 0, 0}, "test");
  const LpmGrid grid = make_grid(consecutive_lines(100, 60), 3);
  const Response g = random_polynomial(3, 3, 2, stream), g_ur = random_polynomial(3, 3, 0, stream);
  const LineSpectra reference = random_phases(grid, stream);
  Spectra z = closed_loop(grid, reference, g, g_ur, Eigen::MatrixXcd::Zero(6, 6), 3, stream);
  FastLpm lpm(grid, 3);
  lpm.load_spectra(z.outputs, z.inputs);
  const Eigen::MatrixXcd before = lpm.indirect(reference).G[30];
  // Exactly a quadratic in frequency: removed to round-off, though fifty times the response.
  for (Eigen::Index m = 0; m < z.outputs.rows(); ++m) {
    const double x = static_cast<double>(m - 200) / 200.0;
    for (int c = 0; c < 3; ++c) {
      z.outputs(m, c) += Complex(50.0, -20.0 * c) + Complex(3.0, 9.0) * x + 7.0 * x * x;
      z.inputs(m, c) += Complex(-5.0, 2.0) + 8.0 * x * x;
    }
  }
  lpm.load_spectra(z.outputs, z.inputs);
  EXPECT_LT((lpm.indirect(reference).G[30] - before).norm(), 1e-11 * before.norm());
}

// A first-order lag y[n+1] = a y[n] + (1-a) u[n], once in its periodic state and once started away from it: what the
// start adds to the spectrum is a rational function with the lag's pole, which the polynomials follow closely.
TEST(FastLpm, RemovesTheTransientOfALagStartedOutsideItsPeriodicState) {
  RandomStream stream({6, 0, 0, 0}, "test");
  const int n = 2000, periods = 3;
  const LpmGrid grid = LpmGrid::create({consecutive_lines(20, 60), n, periods, 50.0}, {}, 1).value();
  const std::vector<double> u = Multisine::random_phase(n, consecutive_lines(20, 60), 1.0, stream).samples(periods);
  Eigen::MatrixXd input(n * periods, 1), periodic(n * periods, 1), started(n * periods, 1);
  const double a = 0.98;
  double y = 0.0;
  for (const double value : u) y = a * y + (1.0 - a) * value;  // a^6000 of the start is left: the periodic state
  double y_started = y + 5.0;
  for (int i = 0; i < n * periods; ++i) {
    input(i, 0) = u[static_cast<std::size_t>(i)];
    periodic(i, 0) = y;
    started(i, 0) = y_started;
    y = a * y + (1.0 - a) * input(i, 0);
    y_started = a * y_started + (1.0 - a) * input(i, 0);
  }
  FastLpm lpm(grid, 1);
  lpm.load(periodic, input);
  const FrmEstimate truth = lpm.direct();
  const auto error = [&](const FrmEstimate& estimate) {
    double worst = 0.0;
    for (int k = 0; k < grid.line_count(); ++k) {
      worst = std::max(worst, std::abs(estimate.G[k](0, 0) / truth.G[k](0, 0) - 1.0));
    }
    return worst;
  };
  lpm.load(started, input);
  const double with_removal = error(lpm.direct());
  // Without removal: the same spectra with nothing in the non-excited bins.
  Eigen::MatrixXcd y_bins = Eigen::MatrixXcd::Zero(grid.bin_count(), 1), u_bins = y_bins;
  const LineSpectra y_lines = spectra_at_lines(grid, started), u_lines = spectra_at_lines(grid, input);
  for (int k = 0; k < grid.line_count(); ++k) {
    y_bins(grid.bin(k), 0) = y_lines(k, 0);
    u_bins(grid.bin(k), 0) = u_lines(k, 0);
  }
  lpm.load_spectra(y_bins, u_bins);
  const double without_removal = error(lpm.direct());
  EXPECT_GT(without_removal, 0.02);
  EXPECT_LT(with_removal, 1e-3 * without_removal);
}

TEST(FastLpm, SaysWhichLinesHaveDependentReferences) {
  RandomStream stream({7, 0, 0, 0}, "test");
  const LpmGrid grid = make_grid(table_lines(), 2);
  const Response g = random_polynomial(2, 2, 1, stream);
  const Response g_ur = [](double) { return Eigen::MatrixXcd::Identity(2, 2); };
  LineSpectra reference = random_phases(grid, stream);
  reference.col(1) = reference.col(0);
  const Spectra z = closed_loop(grid, reference, g, g_ur, random_mixing(4, 0.01, stream), 2, stream);
  FastLpm lpm(grid, 2);
  lpm.load_spectra(z.outputs, z.inputs);
  const FrmEstimate& estimate = lpm.indirect(reference);
  for (int k = 0; k < grid.line_count(); ++k) {
    EXPECT_EQ(estimate.status[static_cast<std::size_t>(k)], LineStatus::singular_regressor);
    EXPECT_TRUE(estimate.G[k].allFinite());
  }
}

TEST(FastLpm, SaysWhichLinesHaveADeadInput) {
  RandomStream stream({8, 0, 0, 0}, "test");
  const LpmGrid grid = make_grid(table_lines(), 2);
  const Response g = random_polynomial(2, 2, 1, stream);
  const Response g_ur = [](double) {
    Eigen::MatrixXcd value = Eigen::MatrixXcd::Identity(2, 2);
    value(1, 1) = 0.0;
    return value;
  };
  const LineSpectra reference = random_phases(grid, stream);
  Spectra z = closed_loop(grid, reference, g, g_ur, Eigen::MatrixXcd::Zero(4, 4), 2, stream);
  FastLpm lpm(grid, 2);
  lpm.load_spectra(z.outputs, z.inputs);
  const FrmEstimate& estimate = lpm.indirect(reference);
  for (int k = 0; k < grid.line_count(); ++k) {
    EXPECT_EQ(estimate.status[static_cast<std::size_t>(k)], LineStatus::singular_input);
    EXPECT_TRUE(estimate.G[k].allFinite());
  }
}

TEST(FastLpm, PermutesWithItsChannels) {
  RandomStream stream({9, 0, 0, 0}, "test");
  const LpmGrid grid = make_grid(table_lines(), 3);
  const Response g = random_polynomial(3, 3, 2, stream), g_ur = random_polynomial(3, 3, 2, stream);
  const LineSpectra reference = random_phases(grid, stream);
  const Spectra z = closed_loop(grid, reference, g, g_ur, random_mixing(6, 0.1, stream), 3, stream);
  FastLpm lpm(grid, 3);
  lpm.load_spectra(z.outputs, z.inputs);
  const FrmEstimate before = lpm.indirect(reference);
  Eigen::PermutationMatrix<3> rows(Eigen::Vector3i(2, 0, 1)), cols(Eigen::Vector3i(1, 0, 2));
  lpm.load_spectra(z.outputs * rows, z.inputs * cols);
  const FrmEstimate& after = lpm.indirect(reference * rows);
  for (int k = 0; k < grid.line_count(); ++k) {
    const Eigen::MatrixXcd expected = rows.transpose() * Eigen::MatrixXcd(before.G[k]) * cols;
    EXPECT_LT((after.G[k] - expected).norm(), 1e-10 * expected.norm());
    const Eigen::MatrixXcd b = cols.transpose() * Eigen::MatrixXcd(before.B[k]) * cols;
    EXPECT_LT((after.B[k] - b).norm(), 1e-10 * b.norm());
    const Eigen::MatrixXcd c = rows.transpose() * Eigen::MatrixXcd(before.C_V[k]) * rows;
    EXPECT_LT((after.C_V[k] - c).norm(), 1e-10 * c.norm());
  }
}

TEST(FastLpm, ScalesWithItsChannelsAndNotWithTheDftScale) {
  RandomStream stream({10, 0, 0, 0}, "test");
  const LpmGrid grid = make_grid(table_lines(), 3);
  const Response g = random_polynomial(3, 3, 2, stream), g_ur = random_polynomial(3, 3, 2, stream);
  const LineSpectra reference = random_phases(grid, stream);
  const Spectra z = closed_loop(grid, reference, g, g_ur, random_mixing(6, 0.1, stream), 3, stream);
  FastLpm lpm(grid, 3);
  lpm.load_spectra(z.outputs, z.inputs);
  const FrmEstimate before = lpm.indirect(reference);
  const double dft = std::sqrt(20'000.0);  // the other usual scale
  lpm.load_spectra(z.outputs * dft, z.inputs * dft);
  const FrmEstimate other_dft = lpm.indirect(reference * dft);
  const Eigen::Vector3d out(1e6, 1.0, 1e-5), in(1e-3, 20.0, 1e4);
  lpm.load_spectra(z.outputs * out.asDiagonal(), z.inputs * in.asDiagonal());
  const FrmEstimate& scaled = lpm.indirect(reference);
  for (int k = 0; k < grid.line_count(); ++k) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const double variance = before.variance(k, i, j);
        EXPECT_NEAR(other_dft.variance(k, i, j), variance, 1e-9 * variance);
        const double gain = out(i) / in(j);
        EXPECT_LT(std::abs(scaled.G[k](i, j) - gain * before.G[k](i, j)), 1e-9 * gain * before.G[k].norm());
        EXPECT_NEAR(scaled.variance(k, i, j), gain * gain * variance, 1e-8 * gain * gain * variance);
      }
    }
  }
}

TEST(ScaleResponse, ScalesTheMatrixAndItsDeviation) {
  RandomStream stream({11, 0, 0, 0}, "test");
  const LpmGrid grid = make_grid(table_lines(), 1);
  const Response g = random_polynomial(1, 1, 2, stream);
  const Response g_ur = [](double) { return Eigen::MatrixXcd::Identity(1, 1); };
  const LineSpectra reference = random_phases(grid, stream);
  const Spectra z = closed_loop(grid, reference, g, g_ur, random_mixing(2, 0.1, stream), 1, stream);
  FastLpm lpm(grid, 1);
  lpm.load_spectra(z.outputs, z.inputs);
  FrmEstimate estimate = lpm.direct();
  const Complex before = estimate.G[3](0, 0);
  const double variance = estimate.variance(3, 0, 0);
  scale_response(estimate, 24.0 / 25.0);
  EXPECT_NEAR(std::abs(estimate.G[3](0, 0) - before * 0.96), 0.0, 1e-15);
  EXPECT_NEAR(estimate.variance(3, 0, 0), variance * 0.96 * 0.96, 1e-15 * variance);
}

}  // namespace
}  // namespace fatmc
