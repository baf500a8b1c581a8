#include "core/stability/stability_monitor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/ident/interpolation_bias.h"
#include "core/random/random_stream.h"
#include "core/signal/multisine.h"

namespace fatmc {
namespace {

constexpr int kPeriod = 400;
constexpr double kRate = 20.0;

/// A loop u = k (r - y) around y[n+1] = 0.9 y[n] + gain u[n]; the gain changes at a sample.
struct Loop {
  Eigen::MatrixXd outputs, inputs, references;
};

std::vector<int> lines() {
  std::vector<int> out;
  for (int k = 5; k <= 65; k += 3) out.push_back(k);
  return out;
}

Loop fly(int periods, int changes_at, double gain_after) {
  RandomStream stream({9, 2, 1, 0}, "monitor");
  const std::vector<double> r = Multisine::random_phase(kPeriod, lines(), 0.3, stream).samples(periods);
  const auto n = static_cast<Eigen::Index>(r.size());
  Loop out{Eigen::MatrixXd(n, 1), Eigen::MatrixXd(n, 1), Eigen::MatrixXd(n, 1)};
  double y = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double measured = y + 1e-3 * stream.normal();
    out.references(i, 0) = r[static_cast<std::size_t>(i)];
    out.outputs(i, 0) = measured;
    out.inputs(i, 0) = 0.5 * (out.references(i, 0) - measured);
    y = 0.9 * y + (i < changes_at ? 0.4 : gain_after) * out.inputs(i, 0) + 1e-3 * stream.normal();
  }
  return out;
}

LpmGrid grid() { return LpmGrid::create({lines(), kPeriod, 2, kRate}, {4, 2, 5}, 1).value(); }

NominalLoop nominal(const LpmGrid& g) {
  SampledModel model{Eigen::MatrixXd::Constant(1, 1, 0.9), Eigen::MatrixXd::Constant(1, 1, 0.4),
                     Eigen::MatrixXd::Ones(1, 1), Eigen::MatrixXd::Zero(1, 1)};
  std::vector<double> frequency_hz;
  for (int k = 0; k < g.line_count(); ++k) frequency_hz.push_back(g.frequency_hz(k));
  return nominal_loop(model, Eigen::MatrixXd::Constant(1, 1, 0.5), frequency_hz, kRate);
}

void push_to(StabilityMonitor& monitor, const Loop& loop, Eigen::Index begin, Eigen::Index end) {
  for (Eigen::Index i = begin; i < end; ++i) {
    monitor.push(std::vector<double>{loop.outputs(i, 0)}, std::vector<double>{loop.inputs(i, 0)},
                 std::vector<double>{loop.references(i, 0)});
  }
}

TEST(StabilityMonitor, JudgesAFullWindowAsTheCommandJudgesTheRecord) {
  const LpmGrid g = grid();
  const Loop loop = fly(4, 1 << 30, 0.4);
  StabilityMonitor monitor(g, 1, nominal(g), {});
  for (const Eigen::Index end :
       {2 * kPeriod, 2 * kPeriod + 137, 4 * kPeriod}) {  // also from the middle of a period
    push_to(monitor, loop,
            static_cast<Eigen::Index>(end == 2 * kPeriod   ? 0
                                      : end == 4 * kPeriod ? 2 * kPeriod + 137
                                                           : 2 * kPeriod),
            end);
    const MonitorEpoch epoch = monitor.epoch();
    FastLpm lpm(g, 1);
    const Eigen::Index begin = end - 2 * kPeriod;
    lpm.load(loop.outputs.middleRows(begin, 2 * kPeriod), loop.inputs.middleRows(begin, 2 * kPeriod));
    const FrmEstimate& estimate =
        lpm.indirect(spectra_at_lines(g, loop.references.middleRows(begin, 2 * kPeriod)));
    const EstimateStability expected = judge_estimate(estimate, interpolation_bias(g, estimate), nominal(g));
    for (int k = 0; k < g.line_count(); ++k) {
      EXPECT_LT(std::abs(monitor.estimate().G[k](0, 0) - estimate.G[k](0, 0)),
                1e-10 * std::abs(estimate.G[k](0, 0)));
      EXPECT_NEAR(monitor.estimate().variance(k, 0, 0) / estimate.variance(k, 0, 0), 1.0, 1e-6);
    }
    EXPECT_TRUE(epoch.window_full);
    EXPECT_EQ(epoch.samples, end);
    EXPECT_NEAR(epoch.band.p_ssv, expected.band.p_ssv, 1e-8);
    EXPECT_NEAR(epoch.band.p_h_infinity, expected.band.p_h_infinity, 1e-8);
    EXPECT_GT(epoch.band.p_ssv, 0.9);
  }
}

TEST(StabilityMonitor, CountsTheBiasWithTheConstantItIsGiven) {
  const LpmGrid g = grid();
  const Loop loop = fly(4, 1 << 30, 0.4);
  std::vector<double> h;
  for (const BiasConstant constant : {BiasConstant::exact_offsets, BiasConstant::limit}) {
    StabilityMonitor monitor(g, 1, nominal(g), {}, constant);
    push_to(monitor, loop, 0, 2 * kPeriod);
    const MonitorEpoch epoch = monitor.epoch();
    const FrmEstimate& estimate = monitor.estimate();
    const EstimateStability expected =
        judge_estimate(estimate, interpolation_bias(g, estimate, constant), nominal(g));
    EXPECT_NEAR(epoch.band.p_h_infinity, expected.band.p_h_infinity, 1e-12);
    h.push_back(expected.lines.front().h_infinity);
  }
  EXPECT_GT(h[0], h[1]);  // the first line's window lies on one side
}

TEST(StabilityMonitor, ASuddenLossOfMarginIsSeenBeforeTheWindowHasPassed) {
  const LpmGrid g = grid();
  const int change = 3 * kPeriod;
  const Loop loop = fly(6, change, 3.4);  // 0.9 - 0.5 * 3.4 = -0.8: stable, with little margin left
  StabilityMonitor monitor(g, 1, nominal(g), {});
  push_to(monitor, loop, 0, change);
  EXPECT_GT(monitor.epoch().band.p_total_ssv, 0.9);
  push_to(monitor, loop, change, change + kPeriod / 2);  // a quarter of the window
  EXPECT_LT(monitor.epoch().band.p_total_ssv, 0.01);
}

TEST(StabilityMonitor, AnEmptyWindowHasNoConfidenceAndSaysThatItIsNotFull) {
  const LpmGrid g = grid();
  StabilityMonitor monitor(g, 1, nominal(g), {});
  monitor.push(std::vector<double>{0.0}, std::vector<double>{0.0}, std::vector<double>{0.0});
  const MonitorEpoch epoch = monitor.epoch();
  EXPECT_FALSE(epoch.window_full);
  EXPECT_EQ(epoch.band.p_total_ssv, 0.0);
  EXPECT_EQ(epoch.band.failed_lines, g.line_count());
}

}  // namespace
}  // namespace fatmc
