// Time of a full epoch of integrity monitoring at the size of T chapter 5, on one core: FFT of 20,000 samples
// of six channels, LPM of 73 lines, interpolation bias, nominal and robust H-infinity and ssv with both
// bounds, CSL.
//
//   epoch_ms       nothing known from before: references new, scalings cold
//   epoch_warm_ms  the next epoch of a window: QR of the references and scalings of ssv known
//   monitor_epochs_per_s  an epoch after every sample of a moving window: sliding DFT, then as above
//   judgement_us_line  of that, the judgement of one line
// The plant is the loop of a flight in outline: three coupled resonances, gain 0.1, estimates with noise.
#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/ident/fast_lpm.h"
#include "core/ident/interpolation_bias.h"
#include "core/random/random_stream.h"
#include "core/signal/multisine.h"
#include "core/stability/estimate_stability.h"
#include "core/stability/stability_monitor.h"

namespace fatmc {
namespace {

constexpr double kRate = 50.0;
constexpr int kPeriod = 10'000;
constexpr int kSamples = 2 * kPeriod;

/// Three resonances at 0.3, 0.6 and 1.5 Hz (damping 0.2), mixed into all channels.
SampledModel plant() {
  SampledModel m;
  m.a = Eigen::MatrixXd::Zero(6, 6);
  m.b = Eigen::MatrixXd::Zero(6, 3);
  m.c = Eigen::MatrixXd::Zero(3, 6);
  m.d = Eigen::MatrixXd::Zero(3, 3);
  const double frequency[] = {0.3, 0.6, 1.5};
  const Eigen::Matrix3d mix = (Eigen::Matrix3d() << 1.0, 0.2, -0.3, 0.1, 1.0, 0.2, -0.2, 0.1, 1.0).finished();
  for (int k = 0; k < 3; ++k) {
    const double w = 2.0 * std::numbers::pi * frequency[k] / kRate;
    const double radius = std::exp(-0.2 * w);
    m.a.block(2 * k, 2 * k, 2, 2) << radius * std::cos(w), radius * std::sin(w), -radius * std::sin(w),
        radius * std::cos(w);
    m.b.row(2 * k) = w * mix.row(k);
    m.c.col(2 * k) = mix.col(k);
  }
  return m;
}

struct Flight {
  LpmGrid grid;
  Eigen::MatrixXd outputs, inputs, references;
  NominalLoop nominal;
};

Flight make_flight() {
  const std::vector<int> lines = lines_from_ranges(table_5_1_ranges(), kRate / kPeriod).value();
  LpmGrid grid = LpmGrid::create({lines, kPeriod, 2, kRate}, {}, 3).value();
  RandomStream stream({1, 0, 0, 0}, "bench");
  Eigen::MatrixXd references(kSamples, 3), outputs(kSamples, 3), inputs(kSamples, 3);
  for (int c = 0; c < 3; ++c) {
    const std::vector<double> r = Multisine::random_phase(kPeriod, lines, 0.03, stream).samples(2);
    for (int i = 0; i < kSamples; ++i) references(i, c) = r[static_cast<std::size_t>(i)];
  }
  const SampledModel model = plant();
  const Eigen::Matrix3d gain = 0.1 * Eigen::Matrix3d::Identity();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(6);
  for (int i = 0; i < kSamples; ++i) {
    Eigen::Vector3d y = model.c * x;
    for (int c = 0; c < 3; ++c) y(c) += 1e-3 * stream.normal();
    const Eigen::Vector3d u = gain * (references.row(i).transpose() - y);
    x = model.a * x + model.b * u;
    for (int c = 0; c < 6; ++c) x(c) += 1e-4 * stream.normal();
    outputs.row(i) = y.transpose();
    inputs.row(i) = u.transpose();
  }
  std::vector<double> frequency_hz;
  for (int k = 0; k < grid.line_count(); ++k) frequency_hz.push_back(grid.frequency_hz(k));
  NominalLoop nominal = nominal_loop(model, gain, frequency_hz, kRate);
  return {std::move(grid), outputs, inputs, references, std::move(nominal)};
}

const Flight& flight() {
  static const Flight f = make_flight();
  return f;
}

void report(benchmark::State& state, const char* name, double unit_s) {
  state.counters[name] = benchmark::Counter(unit_s * static_cast<double>(state.iterations()),
                                            benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// Share of lines whose bounds of ssv meet, so that the figure is known to be of a whole computation.
void report_met(benchmark::State& state, const EstimateStability& last) {
  int met = 0;
  for (const LineStability& line : last.lines) met += line.ssv.certified() ? 1 : 0;
  state.counters["met_percent"] = 100.0 * met / static_cast<double>(last.lines.size());
}

void epoch(benchmark::State& state) {
  const Flight& f = flight();
  FastLpm lpm(f.grid, 3);
  const LineSpectra reference = spectra_at_lines(f.grid, f.references);
  EstimateStability last;
  for (auto _ : state) {
    lpm.load(f.outputs, f.inputs);
    const FrmEstimate& estimate = lpm.indirect(reference);
    last = judge_estimate(estimate, interpolation_bias(f.grid, estimate), f.nominal);
    benchmark::DoNotOptimize(last.band.p_total_ssv);
  }
  report(state, "epoch_ms", 1e-3);
  report_met(state, last);
}
BENCHMARK(epoch)->Name("epoch_ms")->Unit(benchmark::kMillisecond);

void epoch_warm(benchmark::State& state) {
  const Flight& f = flight();
  FastLpm lpm(f.grid, 3);
  const LpmDesign design(f.grid, spectra_at_lines(f.grid, f.references));
  EstimateScalings scalings;
  EstimateStability last;
  for (auto _ : state) {
    lpm.load(f.outputs, f.inputs);
    const FrmEstimate& estimate = lpm.indirect(design);
    last = judge_estimate(estimate, interpolation_bias(f.grid, estimate), f.nominal, {}, &scalings);
    benchmark::DoNotOptimize(last.band.p_total_ssv);
  }
  report(state, "epoch_warm_ms", 1e-3);
  report_met(state, last);
}
BENCHMARK(epoch_warm)->Name("epoch_warm_ms")->Unit(benchmark::kMillisecond);

void monitor(benchmark::State& state) {
  const Flight& f = flight();
  StabilityMonitor monitor(f.grid, 3, f.nominal, {});
  std::vector<double> y(3), u(3), r(3);
  int next = 0;
  const auto push = [&] {
    for (int c = 0; c < 3; ++c) {
      const auto at = static_cast<std::size_t>(c);
      y[at] = f.outputs(next, c);
      u[at] = f.inputs(next, c);
      r[at] = f.references(next, c);
    }
    monitor.push(y, u, r);
    next = (next + 1) % kSamples;
  };
  for (int i = 0; i < kSamples; ++i) push();
  for (auto _ : state) {
    push();
    benchmark::DoNotOptimize(monitor.epoch().band.p_total_ssv);
  }
  state.counters["monitor_epochs_per_s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(monitor)->Name("monitor_epochs_per_s")->Unit(benchmark::kMillisecond);

void judgement(benchmark::State& state) {
  const Flight& f = flight();
  FastLpm lpm(f.grid, 3);
  lpm.load(f.outputs, f.inputs);
  const FrmEstimate& estimate = lpm.indirect(spectra_at_lines(f.grid, f.references));
  const MatrixStack<double> bias = interpolation_bias(f.grid, estimate);
  EstimateStability last;
  for (auto _ : state) {
    last = judge_estimate(estimate, bias, f.nominal);
    benchmark::DoNotOptimize(last.band.p_total_ssv);
  }
  report(state, "judgement_us_line", 73e-6);
}
BENCHMARK(judgement)->Name("judgement_us_line")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace fatmc

BENCHMARK_MAIN();
