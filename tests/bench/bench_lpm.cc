// Time of the fast LPM at the size of T chapter 5: 73 lines of Table 5-1, six channels of 20,000 samples, three inputs.
//
//   lpm_73_lines_ms       everything: six DFTs, transient, noise, QR of a new reference, estimate, covariances
//   lpm_line_us_cold      regression of one of the lines on a new reference, QR included
//   lpm_line_us_prepared  the same with the QR known
// Each reports its figure as a counter of its own name, in the unit of the name.
#include <benchmark/benchmark.h>

#include <Eigen/Core>

#include "core/ident/fast_lpm.h"
#include "core/ident/interpolation_bias.h"
#include "core/random/random_stream.h"
#include "core/signal/dft.h"
#include "core/signal/multisine.h"

namespace fatmc {
namespace {

struct Experiment {
  LpmGrid grid;
  Eigen::MatrixXd outputs, inputs;
  LineSpectra reference;
};

Experiment make_experiment() {
  const std::vector<int> lines = lines_from_ranges(table_5_1_ranges(), 0.005).value();
  LpmGrid grid = LpmGrid::create({lines, 10'000, 2, 50.0}, {}, 3).value();
  RandomStream stream({1, 0, 0, 0}, "bench");
  Eigen::MatrixXd inputs(20'000, 3), outputs(20'000, 3);
  LineSpectra reference(73, 3);
  for (int c = 0; c < 3; ++c) {
    const Multisine sine = Multisine::random_phase(10'000, lines, 0.03, stream);
    const std::vector<double> x = sine.samples(2);
    const auto spectrum = sine.spectrum(2);
    for (int i = 0; i < 20'000; ++i) {
      inputs(i, c) = x[static_cast<std::size_t>(i)] + 1e-3 * stream.normal();
      outputs(i, c) = 0.5 * x[static_cast<std::size_t>(i)] + 1e-3 * stream.normal();
    }
    for (int k = 0; k < 73; ++k) reference(k, c) = spectrum[static_cast<std::size_t>(k)];
  }
  return {std::move(grid), outputs, inputs, reference};
}

const Experiment& experiment() {
  static const Experiment e = make_experiment();
  return e;
}

/// Time of an iteration in units of `unit_s` seconds.
void report(benchmark::State& state, const char* name, double unit_s) {
  state.counters[name] = benchmark::Counter(unit_s * static_cast<double>(state.iterations()),
                                            benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void lpm_73_lines_ms(benchmark::State& state) {
  const Experiment& e = experiment();
  FastLpm lpm(e.grid, 3);
  for (auto _ : state) {
    lpm.load(e.outputs, e.inputs);
    benchmark::DoNotOptimize(lpm.indirect(e.reference).G.data(0));
  }
  report(state, "lpm_73_lines_ms", 1e-3);
}
BENCHMARK(lpm_73_lines_ms)->Unit(benchmark::kMillisecond);

void lpm_line_us_cold(benchmark::State& state) {
  const Experiment& e = experiment();
  FastLpm lpm(e.grid, 3);
  lpm.load(e.outputs, e.inputs);
  for (auto _ : state) benchmark::DoNotOptimize(lpm.indirect(e.reference).G.data(0));
  report(state, "lpm_line_us_cold", 73e-6);
}
BENCHMARK(lpm_line_us_cold)->Unit(benchmark::kMicrosecond);

void lpm_line_us_prepared(benchmark::State& state) {
  const Experiment& e = experiment();
  FastLpm lpm(e.grid, 3);
  lpm.load(e.outputs, e.inputs);
  const LpmDesign design(e.grid, e.reference);
  for (auto _ : state) benchmark::DoNotOptimize(lpm.indirect(design).G.data(0));
  report(state, "lpm_line_us_prepared", 73e-6);
}
BENCHMARK(lpm_line_us_prepared)->Unit(benchmark::kMicrosecond);

void lpm_interpolation_bias(benchmark::State& state) {
  const Experiment& e = experiment();
  FastLpm lpm(e.grid, 3);
  lpm.load(e.outputs, e.inputs);
  const FrmEstimate& estimate = lpm.indirect(e.reference);
  for (auto _ : state) benchmark::DoNotOptimize(interpolation_bias(e.grid, estimate).data(0));
}
BENCHMARK(lpm_interpolation_bias)->Unit(benchmark::kMicrosecond);

void dft_20000_samples(benchmark::State& state) {
  const Experiment& e = experiment();
  const RealDft dft(20'000);
  std::vector<std::complex<double>> bins(static_cast<std::size_t>(e.grid.bin_count()));
  for (auto _ : state) {
    dft.transform({e.outputs.col(0).data(), 20'000}, bins);
    benchmark::DoNotOptimize(bins.data());
  }
}
BENCHMARK(dft_20000_samples)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace fatmc

BENCHMARK_MAIN();
