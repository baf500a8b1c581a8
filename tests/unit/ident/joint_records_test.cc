#include "core/ident/joint_records.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/ident/estimators.h"
#include "core/ident/output_prediction.h"
#include "core/random/random_stream.h"
#include "core/signal/dft.h"
#include "core/stats/confidence.h"

namespace fatmc {
namespace {

using Complex = std::complex<double>;
constexpr int kSamples = 1024;

std::size_t index(Eigen::Index i) { return static_cast<std::size_t>(i); }

/// G(f) of a smooth 2 x 2 system, plus a resonance of `width` bins at bin 200 in the first row.
Eigen::Matrix2cd response(int bin, double width) {
  const double x = bin / 512.0;
  Eigen::Matrix2cd g;
  g << Complex(1.0 + x, -x), Complex(0.3, 0.2 * x), Complex(-0.5 * x, 0.1), Complex(2.0 - x, x);
  if (width > 0.0) g.row(0) += Eigen::RowVector2cd(1.0, 0.5) / Complex(width, bin - 200.0);
  return g;
}

/// E records of white inputs through `response`, circularly, with white output noise.
std::vector<Measurement> records(int count, double width, double noise, std::uint64_t seed) {
  std::vector<Measurement> out;
  for (int e = 0; e < count; ++e) {
    RandomStream stream({seed, static_cast<std::uint64_t>(e), 0, 0}, "joint");
    Measurement m;
    m.experiment.rate_hz = 100.0;
    m.inputs.resize(kSamples, 2);
    m.outputs.resize(kSamples, 2);
    for (Eigen::Index i = 0; i < m.inputs.size(); ++i) m.inputs.data()[i] = stream.normal();
    std::vector<Complex> u[2], y[2];
    for (int j = 0; j < 2; ++j) {
      u[j].resize(kSamples / 2 + 1);
      y[j].resize(kSamples / 2 + 1);
      RealDft(kSamples).transform({m.inputs.col(j).data(), kSamples}, u[j]);
    }
    for (int k = 0; k <= kSamples / 2; ++k) {
      const Eigen::Vector2cd v = response(k, width) * Eigen::Vector2cd(u[0][index(k)], u[1][index(k)]);
      for (int i = 0; i < 2; ++i) y[i][index(k)] = k == 0 || k == kSamples / 2 ? Complex(v(i).real()) : v(i);
    }
    for (int i = 0; i < 2; ++i) {
      inverse_real_dft(y[i], {m.outputs.col(i).data(), kSamples});
      for (int n = 0; n < kSamples; ++n) m.outputs(n, i) += noise * stream.normal();
    }
    out.push_back(std::move(m));
  }
  return out;
}

TEST(JointRecords, GiveTheResponseOfNoiseFreeRecordsWhateverItsShape) {
  const auto estimate = joint_records(records(3, 0.5, 0.0, 1), {});
  ASSERT_TRUE(estimate) << estimate.error().text();
  const FrmEstimate& frm = estimate->frm;
  ASSERT_EQ(frm.line_count(), 511);
  double worst = 0.0;
  for (int k = 0; k < frm.line_count(); ++k) {
    const int bin = frm.lines[index(k)];
    if (bin < 5 || bin > 505) continue;  // white inputs: no bin is empty, but some are small
    worst = std::max(worst, (frm.G[k] - response(bin, 0.5)).cwiseAbs().maxCoeff());
  }
  EXPECT_LT(worst, 1e-9);
}

TEST(JointRecords, TakeThoseBinsByThemselvesWhereSmoothingShows) {
  const auto estimate = joint_records(records(4, 1.0, 0.001, 2), {});
  ASSERT_TRUE(estimate);
  EXPECT_THAT(estimate->fallback, ::testing::IsSupersetOf({197, 198, 199, 200, 201, 202, 203}));
  EXPECT_LT(estimate->fallback.size(), 90U);
  ASSERT_EQ(estimate->notes.size(), 1U);
  EXPECT_THAT(estimate->notes[0], ::testing::HasSubstr("of 511 lines are solved by themselves"));
  const FrmEstimate& frm = estimate->frm;
  for (int k = 0; k < frm.line_count(); ++k) {
    if (frm.lines[index(k)] != 200) continue;
    EXPECT_LT(std::abs(frm.G[k](0, 0) - response(200, 1.0)(0, 0)), 0.01);
  }
}

/// Impulses whose signs are orthogonal over four records: every bin has the inputs N^-1/2 [1, 1], N^-1/2 [1, -1] twice.
std::vector<Measurement> orthogonal_records(double noise, std::uint64_t seed) {
  std::vector<Measurement> out;
  for (int e = 0; e < 4; ++e) {
    RandomStream stream({seed, static_cast<std::uint64_t>(e), 0, 0}, "joint");
    Measurement m;
    m.experiment.rate_hz = 100.0;
    m.inputs.setZero(kSamples, 2);
    m.inputs.row(0) << 1.0, e % 2 == 0 ? 1.0 : -1.0;
    m.outputs = m.inputs;  // G = I
    for (Eigen::Index i = 0; i < m.outputs.size(); ++i) m.outputs.data()[i] += noise * stream.normal();
    out.push_back(std::move(m));
  }
  return out;
}

/// Variance of a quadratic's value in the middle of w equal points, over that of one point: 3 (3 w^2 - 7)/(4 w (w^2 - 4)).
double quadratic_gain(int w) { return 3.0 * (3.0 * w * w - 7.0) / (4.0 * w * (w * w - 4.0)); }

TEST(JointRecords, SmoothingLowersTheReportedVarianceByTheGainOfItsQuadraticAndNothingElsewhere) {
  const double noise = 0.1, alone_b = kSamples / 4.0;  // (U^H U)^-1 of a bin
  for (const int n_e : {2, 9}) {
    const auto estimate = joint_records(orthogonal_records(noise, 3), {.n_e = n_e});
    ASSERT_TRUE(estimate);
    const FrmEstimate& frm = estimate->frm;
    const int width = 2 * n_e + 1;
    EXPECT_EQ(frm.q, width * 2);
    double sum = 0.0;
    int smoothed = 0, count = 0;
    for (int k = n_e; k + n_e < frm.line_count(); ++k, ++count) {
      const bool alone =
          std::binary_search(estimate->fallback.begin(), estimate->fallback.end(), frm.lines[index(k)]);
      const double b = alone ? alone_b : alone_b * quadratic_gain(width);
      smoothed += alone ? 0 : 1;
      for (int j = 0; j < 2; ++j) {
        EXPECT_NEAR(frm.B[k](j, j).real(), b, 1e-9 * b);
        for (int i = 0; i < 2; ++i) {
          EXPECT_NEAR(frm.variance(k, i, j), frm.B[k](j, j).real() * frm.C_V[k](i, i).real(),
                      1e-12 * frm.variance(k, i, j));
        }
      }
      sum += frm.C_V[k](0, 0).real() / (noise * noise);
    }
    EXPECT_GT(smoothed, 9 * count / 10);
    // 2 degrees of freedom a bin, the two ends of the record apart
    EXPECT_NEAR(sum / count, 1.0, 3.0 / std::sqrt(2.0 * count)) << n_e;
  }
}

TEST(JointRecords, ErrorsFollowTheLawOfTheirVarianceAndTheGuardItsLevel) {
  // Windows 19 bins apart share nothing: 25 of them a run, 60 runs.
  int inside = 0, alone = 0, count = 0;
  for (std::uint64_t run = 0; run < 60; ++run) {
    const auto estimate = joint_records(records(4, 0.0, 0.3, 100 + run), {});
    ASSERT_TRUE(estimate);
    const double limit = f_quantile_2_2q(0.95, estimate->frm.q);
    for (int k = 20; k < 490; k += 19, ++count) {
      const int bin = estimate->frm.lines[index(k)];
      const Complex g0 = response(bin, 0.0)(1, 0);
      alone += std::binary_search(estimate->fallback.begin(), estimate->fallback.end(), bin) ? 1 : 0;
      inside += std::norm(estimate->frm.G[k](1, 0) - g0) <= limit * estimate->frm.variance(k, 1, 0) ? 1 : 0;
    }
  }
  const auto near = [count](int hits, double share) {
    EXPECT_NEAR(static_cast<double>(hits) / count, share, 3.0 * std::sqrt(share * (1.0 - share) / count));
  };
  near(inside, 0.95);
  near(alone, 1.0 - kMisfitLevel * kMisfitLevel);  // false alarms of the guard, in either output
}

TEST(JointRecords, KeepToTheBand) {
  auto set = records(3, 0.0, 0.1, 4);
  for (Measurement& m : set) {
    m.low_hz = 50 * 100.0 / kSamples;
    m.high_hz = 99 * 100.0 / kSamples;
  }
  const auto estimate = joint_records(set, {});
  ASSERT_TRUE(estimate);
  EXPECT_EQ(estimate->frm.lines.front(), 50);
  EXPECT_EQ(estimate->frm.lines.back(), 99);
  EXPECT_EQ(estimate->frm.border[8], 1);
  EXPECT_EQ(estimate->frm.border[9], 0);
}

TEST(JointRecords, AreRefusedWhereTheyDetermineNothing) {
  const auto message = [](const Result<ResponseEstimate>& r) { return r ? "accepted" : r.error().text(); };
  EXPECT_THAT(message(joint_records(records(2, 0.0, 0.1, 5), {})),
              ::testing::HasSubstr("3 or more; there are 2"));
  EXPECT_THAT(message(joint_records(records(3, 0.0, 0.1, 5), {.n_e = 1, .order = 2})),
              ::testing::HasSubstr("take n_E >= 2"));
  auto uneven = records(3, 0.0, 0.1, 5);
  uneven[1].inputs.conservativeResize(1000, 2);
  EXPECT_THAT(message(joint_records(uneven, {})), ::testing::HasSubstr("differ in length"));
  auto same = records(3, 0.0, 0.1, 5);
  for (Measurement& m : same) m.inputs.col(1) = m.inputs.col(0);
  const auto singular = joint_records(same, {});
  ASSERT_TRUE(singular);
  for (const LineStatus status : singular->frm.status) EXPECT_EQ(status, LineStatus::singular_regressor);
}

TEST(OutputPrediction, IsExactWhereResponseAndRecordHaveOneGrid) {
  const auto set = records(4, 0.5, 0.0, 6);
  const auto estimate = joint_records(std::span(set).first(3), {});
  ASSERT_TRUE(estimate);
  const auto p =
      predict_outputs(estimate->frm.frequency_hz, estimate->frm.G, set[3].outputs, set[3].inputs, 100.0);
  ASSERT_TRUE(p) << p.error().text();
  EXPECT_EQ(p->first_bin, 1);
  EXPECT_EQ(p->last_bin, 511);
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(p->vaf(i), 1.0, 1e-9);
    EXPECT_NEAR(p->band_share(i), 1.0, 0.01);  // the bin at half the rate is not among the lines
  }
  EXPECT_LT((p->measured - p->predicted).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(OutputPrediction, InterpolatesALinearResponseExactly) {
  // Lines 3 Hz apart, a response linear in f between them, a record of 10 s.
  const int n = 1000;
  const std::vector<double> lines = {2.0, 5.0, 8.0};
  MatrixStack<Complex> g(1, 1, 3);
  for (int k = 0; k < 3; ++k) g[k](0, 0) = Complex(1.0, 0.5) + 0.2 * lines[index(k)];
  Eigen::MatrixXd u(n, 1), y(n, 1);
  for (int i = 0; i < n; ++i) {
    const double a = 2.0 * std::numbers::pi * i / n;
    u(i, 0) = std::cos(35.0 * a) + std::cos(65.0 * a);  // 3.5 and 6.5 Hz
    const Complex at[2] = {Complex(1.7, 0.5), Complex(2.3, 0.5)};
    y(i, 0) = (at[0] * std::polar(1.0, 35.0 * a) + at[1] * std::polar(1.0, 65.0 * a)).real() + 3.0 +
              std::cos(300.0 * a);
  }
  const auto p = predict_outputs(lines, g, y, u, 100.0);
  ASSERT_TRUE(p);
  EXPECT_EQ(p->first_bin, 20);
  EXPECT_EQ(p->last_bin, 80);
  EXPECT_NEAR(p->vaf(0), 1.0, 1e-12);
  const double in_band = (std::norm(Complex(1.7, 0.5)) + std::norm(Complex(2.3, 0.5))) / 2.0;
  EXPECT_NEAR(p->band_share(0), in_band / (in_band + 0.5), 1e-9);
}

TEST(OutputPrediction, CountsAnErrorAsItsShareOfTheMeasuredEnergy) {
  auto set = records(4, 0.0, 0.0, 7);
  const auto estimate = joint_records(std::span(set).first(3), {});
  ASSERT_TRUE(estimate);
  FrmEstimate frm = estimate->frm;
  for (int k = 0; k < frm.line_count(); ++k) frm.G[k] *= 0.9;
  const auto p = predict_outputs(frm.frequency_hz, frm.G, set[3].outputs, set[3].inputs, 100.0);
  ASSERT_TRUE(p);
  EXPECT_NEAR(p->vaf(0), 0.99, 1e-9);
  const auto none =
      predict_outputs({60.0, 70.0}, MatrixStack<Complex>(2, 2, 2), set[3].outputs, set[3].inputs, 100.0);
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().text(), ::testing::HasSubstr("lies between the response's lines, 60 to 70 Hz"));
}

}  // namespace
}  // namespace fatmc
